"""Every dataset of a results file with its type, shape, unit and meaning."""

import sys

import h5py

with h5py.File(sys.argv[1] if len(sys.argv) > 1 else "study.h5") as file:
    def show(path, item):
        if isinstance(item, h5py.Dataset):
            print(path, item.dtype, item.shape, item.attrs["units"], item.attrs["long_name"], sep="\t")
    file.visititems(show)
