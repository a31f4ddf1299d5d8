"""What every room uses and what knows nothing of records.

Calls spread over processors, types of values, how numbers are said. Uses no other room.
"""
