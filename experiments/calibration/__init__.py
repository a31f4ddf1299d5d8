"""`make calibrate`: streams of rounds of contenders whose true ratios are known.

The analysis makes small studies of them, and tells how often verdicts are wrong on this machine.
"""
