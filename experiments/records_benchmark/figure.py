"""What reading costs over the number of records, drawn."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from matplotlib.figure import Figure

_SHOWN = {
    "status_first": ("`status`, nothing kept", "C0", "o-"),
    "status_again": ("`status`, again", "C0", "o--"),
    "report_first": ("report's reading, nothing kept", "C1", "s-"),
    "report_again": ("report's reading, again", "C1", "s--"),
}


def draw(rows: Sequence[Mapping[str, float]], path: Path) -> None:
    """Draw the seconds of each row, a panel for each size of a record, both axes logarithmic."""
    sizes = sorted({row["bytes_each"] for row in rows})
    figure = Figure(figsize=(7, 3), layout="constrained")
    panels = figure.subplots(1, len(sizes), sharey=True, squeeze=False)[0]
    for panel, size in zip(panels, sizes, strict=True):
        part = sorted((row for row in rows if row["bytes_each"] == size), key=lambda row: row["records"])
        records = [row["records"] for row in part]
        for key, (name, colour, style) in _SHOWN.items():
            label = name.replace("`", "")
            panel.loglog(records, [row[key] for row in part], style, color=colour, label=label, markersize=4)
        first = part[0]
        linear = [first["status_first"] * count / first["records"] for count in records]
        panel.loglog(records, linear, ":", color="0.6", label="in proportion to the records")
        panel.set(title=f"records of {size / 1000:.0f} KB", xlabel="records")
        panel.set_xticks(records, [f"{count:,}" for count in records])
        panel.minorticks_off()
        panel.grid(visible=True, which="major", color="0.9")
    panels[0].set_ylabel("seconds")
    panels[-1].legend(fontsize=7)
    figure.savefig(path, metadata={"Date": None})
