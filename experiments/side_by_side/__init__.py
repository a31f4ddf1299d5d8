"""Programs measured beside each other: `carom processes` samples, what is decided is decided here.

`sampler` runs some in slices and tells the facts of each (`run_result`); `contest` decides who runs when, who
minds being stopped and which runs count; `printed_time` and `benchmark_time` read the time that a program
says of itself (`stated_time`). Uses `plan` and `support`; knows nothing of points and of results folders.
"""
