"""What a results folder holds, and how several become one.

Uses `plan` and `support`.
"""
