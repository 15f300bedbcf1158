# SPDX-License-Identifier: BSD-3-Clause
"""The look of the figures: colours that colour-blind readers tell apart (Okabe and Ito), with markers and lines that a print in grey tells apart."""
BLUE, ORANGE, GREEN, PURPLE, GREY = "#0072B2", "#D55E00", "#009E73", "#CC79A7", "#666666"


def panels(title, count, **options):
    """A figure with a title, and its axes side by side."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as pyplot
    figure, axes = pyplot.subplots(1, count, figsize=(10, 4.6), layout="constrained", **options)
    figure.suptitle(title, fontsize=13, weight="bold")
    for one in axes:
        one.grid(which="major", alpha=0.3)
        one.spines[["top", "right"]].set_visible(False)
    return figure, axes


def plain_numbers(axis, ticks=(1,)):
    """A logarithmic axis with ticks as 0.01, 1,000 or 10 million, not as powers of ten, at these multiples of the powers."""
    from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter
    axis.set_major_locator(LogLocator(subs=ticks))
    axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / 1e6:g} million" if value >= 1e6 else f"{value:,.9g}"))
    axis.set_minor_formatter(NullFormatter())


def save(figure, file, stamp):
    """Writes the picture, with the line that says where its numbers are from."""
    import matplotlib.pyplot as pyplot
    figure.supxlabel(stamp, fontsize=7.5, color=GREY)
    figure.savefig(file, dpi=110, metadata={"Software": None})
    pyplot.close(figure)
