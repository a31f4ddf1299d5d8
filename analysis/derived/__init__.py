"""What is worked out of a study before it is drawn or judged.

Errors beside time, the ladder, hard cases, counts a disc and step, and how near to what cannot be avoided.
Uses `records`, `statistics` and `support`.
"""
