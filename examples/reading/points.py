"""The same table from what `zerocount export study.h5 -o tables` writes."""

import csv

with open("tables/points.csv", newline="", encoding="utf-8") as file:
    for row in csv.DictReader(file):
        values = [float(row[name]) for name in (
            "success_rate", "success_rate_low", "success_rate_high",
            "arrival_time_median [s]", "arrival_time_p95 [s]", "jerk_count_mean")]
        print(row["label"], int(float(row["trials"])), *values, sep="\t")
