"""Opens a results file with h5py, xarray (both engines) and netCDF4, and checks what a reader may rely on.

Usage: open_with_python.py FILE TRIALS MOVES JERKS RECORDS (numbers of rows that the tables should have)
"""

import hashlib
import sys

import h5py
import netCDF4
import numpy
import xarray

path = sys.argv[1]
trials, moves, jerks, records = map(int, sys.argv[2:6])

sizes = {
    "/point": {"point": None},
    "/level": {"point": None, "move": moves},
    "/trial": {"trial": trials},
    "/trial/input": {"trial": trials},
    "/outcome": {"trial": trials, "move": moves, "band": 2},
    "/jerk": {"jerk": jerks},
    "/trace": {"record": records},
    "/profile/friction.k1": {"theta": 4096},
    "/profile/friction.k2": {"machine": 8, "theta": 64},
    "/machine": {"point": None, "machine": 8},
    "/machine/input": {"machine": 8},
}


def check_h5py(file):
    assert isinstance(file.attrs["name"], str) and file.attrs["complete"] == 1

    def check(name, item):
        if not isinstance(item, h5py.Dataset):
            return
        assert isinstance(item.attrs["units"], str) and item.attrs["units"], name
        assert isinstance(item.attrs["long_name"], str) and item.attrs["long_name"], name
        numeric = h5py.check_string_dtype(item.dtype) is None
        if item.ndim and numeric:
            assert item.shuffle and item.fletcher32 and item.compression == "gzip", name
        if not numeric:
            information = h5py.check_string_dtype(item.dtype)
            assert information.encoding == "utf-8" and information.length is None, name
        if not h5py.h5ds.is_scale(item.id):
            for dimension in item.dims:
                assert len(dimension) == 1, f"{name}: one scale on every axis"
        if "flag_values" in item.attrs:
            assert item.attrs["flag_values"].dtype == item.dtype, name
            assert len(item.attrs["flag_meanings"].split()) == len(item.attrs["flag_values"]), name
        assert not item.id.get_create_plist().get_obj_track_times(), name
        item[()]

    file.visititems(check)
    tracked = h5py.h5p.CRT_ORDER_TRACKED | h5py.h5p.CRT_ORDER_INDEXED
    for group in [file] + [file[name] for name in sizes if name in file]:
        properties = h5py.h5g.open(file.id, group.name.encode()).get_create_plist()
        assert properties.get_link_creation_order() == tracked, group.name
    assert list(file["outcome"])  # readable in any order


def check_seal():
    with open(path, "rb") as file:
        contents = file.read()
    digest = hashlib.sha256(contents[:-87]).hexdigest()
    assert contents[-87:].decode() == f"zerocount-seal sha256 {digest}\n"


def check_xarray(file, engine):
    with xarray.open_dataset(path, engine=engine) as root:
        assert str(root.manifest.values[()]) == file["manifest"].asstr()[()]
        assert list(root.overrides.values) == list(file["overrides"].asstr()[:])
    for name, expected in sizes.items():
        if name not in file:
            continue
        with xarray.open_dataset(path, group=name, engine=engine) as group:
            for dimension, size in expected.items():
                assert size is None or group.sizes[dimension] == size, (engine, name, dict(group.sizes))
            found = set(group.sizes) - ({"band"} if name == "/point" else set())  # in files with statistics
            assert found == set(expected), (engine, name, dict(group.sizes))
            for variable in group.variables:
                stored = file[name][variable]
                values = stored.asstr()[()] if h5py.check_string_dtype(stored.dtype) else stored[()]
                numpy.testing.assert_array_equal(group[variable].values, values, err_msg=f"{engine} {name} {variable}")
                assert group[variable].attrs["units"] == stored.attrs["units"], variable


check_seal()
with h5py.File(path) as opened:
    check_h5py(opened)
    for used_engine in ("h5netcdf", "netcdf4"):
        check_xarray(opened, used_engine)
with netCDF4.Dataset(path) as opened:
    assert opened["outcome/arrival_time"].dimensions == ("trial", "move")
    assert opened["trial/trial"].dimensions == ("trial",)
print("opened")
