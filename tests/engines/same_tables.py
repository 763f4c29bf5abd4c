"""Compares the tables of one study through several engines: all but times, bit by bit; CSV against Parquet."""
import sys

import pandas as pd
import pyarrow.parquet as pq

work, first, *others = sys.argv[1:]


def read(name):
    table = pd.read_parquet(f"{work}/{name}/table.parquet")
    text = pd.read_csv(f"{work}/{name}/table.csv")
    units = pq.read_schema(f"{work}/{name}/table.parquet").metadata[b"units"]
    bare = [column.partition(" [")[0] for column in text.columns]
    assert bare == list(table.columns), (bare, list(table.columns))
    assert b'"energy.friction":"J/m"' in units, units
    for column, heading in zip(table.columns, text.columns):
        if table[column].dtype.kind in "if":
            assert (table[column].fillna(-1) == text[heading].fillna(-1)).all(), column
    return table.drop(columns=["cpu_seconds", "wall_seconds"])


expected = read(first)
assert len(expected) == 8 and set(expected["status"]) == {"done", "rejected"}, expected
assert expected[expected.status == "rejected"].reason.str.contains("did not converge").all()
assert expected["identity"].nunique() == 8
for name in others:
    pd.testing.assert_frame_equal(read(name), expected, check_exact=True)
    print(f"{name}: {len(expected)} runs as {first}")
