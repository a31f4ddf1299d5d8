"""What every room uses and what knows nothing of records.

Files that are whole or not there, calls spread over processors, how numbers are said. Uses no other room.
"""
