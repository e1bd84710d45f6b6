"""Pictures in print: widths of journals' columns, one style, letters on panels."""

import matplotlib.pyplot as plt
import pytest

from crazybilliards.comparison.layout import house_style, legend_above, panels


@pytest.mark.parametrize(("columns", "width"), [(None, 7.0), (1, 3.4), (2, 7.0)])
def test_a_figure_is_one_or_two_columns_wide_with_letters_of_8_points(columns, width):
    with house_style(columns):
        figure, axes = panels(1, 3, sharey=True, width_ratios=(2, 1, 1))
        for ax in axes:
            ax.plot([1, 2], [3, 4])
            ax.set_xlabel("x")
        figure.draw_without_rendering()
        sizes = {
            text.get_fontsize() for ax in axes for text in (ax.xaxis.label, *ax.get_xticklabels())
        }
    assert figure.get_figwidth() == width
    assert sizes == {8}
    assert [ax.get_title(loc="left") for ax in axes] == ["(a)", "(b)", "(c)"]
    # In one column they stand one below the other: none is too narrow to be read.
    stacked = len({ax.get_position().x0 for ax in axes}) == 1
    assert stacked == (columns == 1)


def test_a_single_panel_has_no_letter_and_is_one_column_wide_unless_asked():
    with house_style():
        figure, [ax] = panels(1, 1, wanted=1)
    assert (figure.get_figwidth(), ax.get_title(loc="left")) == (3.4, "")
    with house_style(2):
        assert panels(1, 1, wanted=1)[0].get_figwidth() == 7.0


def test_the_style_acts_inside_only():
    before = dict(plt.rcParams)
    with house_style(1):
        assert plt.rcParams["font.size"] == 8
    assert dict(plt.rcParams) == before


def test_a_legend_above_is_not_wider_than_the_figure():
    with house_style(1):
        figure, [ax] = panels(1, 1, wanted=1)
        for number in range(7):
            ax.plot([0, 1], [0, number], label=f"a rather long name, number {number}")
        legend_above(figure, ax)
        figure.draw_without_rendering()
        box = figure.legends[0].get_window_extent()
    assert box.width < figure.bbox.width
    assert len(figure.legends[0].get_texts()) == 7
