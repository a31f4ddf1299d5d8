"""From JSON files to tables, and from tables to studies that may be compared.

Beside the records: the published series, timelines, trajectories. Uses `support`.
"""
