"""Pictures in print: widths of journals' columns, one style, letters on panels."""

import os
import sys

import matplotlib.pyplot as plt
import pytest
from installation import run

from crazybilliards.comparison.layout import house_style, legend_above, panels


@pytest.mark.parametrize(("columns", "width"), [(1, 3.4), (3, 7.0)])
def test_a_figure_is_one_or_two_columns_wide_with_letters_of_8_points(columns, width):
    with house_style():
        figure, axes = panels(2, columns, sharey=True)
        for ax in axes:
            ax.plot([1, 2], [3, 4], label="a rather long name of a curve")
            ax.set_xlabel("x")
        legend_above(figure, *axes)
        figure.draw_without_rendering()
        texts = [text for ax in axes for text in (ax.xaxis.label, *ax.get_xticklabels())]
        assert figure.legends[0].get_window_extent().width < figure.bbox.width
    assert figure.get_figwidth() == width
    assert {text.get_fontsize() for text in texts} == {8}
    assert [ax.get_title(loc="left") for ax in axes[:2]] == ["(a)", "(b)"]
    assert len(figure.legends[0].get_texts()) == 1


def test_the_style_acts_inside_only():
    before = dict(plt.rcParams)
    with house_style():
        assert plt.rcParams["font.size"] == 8
    assert dict(plt.rcParams) == before


@pytest.mark.compiled
def test_commands_draw_whatever_the_backend_of_the_reader_is(tmp_path):
    options = ["--size", "4", "--duration", "200", "--amplitude", "1", "--output", tmp_path]
    code = "from crazybilliards.apps.commands.line import main; main()"
    environment = os.environ | {"MPLBACKEND": "nonsense"}
    run(sys.executable, "-Wignore", "-c", code, "compare", *options, env=environment)
    assert {path.stem for path in tmp_path.glob("*.png")} == {"density", "displacement", "widths"}
