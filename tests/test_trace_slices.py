"""Trace slices: the paper's figures 3 and 4, reading and writing, and what callers get wrong."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from flowtex import FlowField, TraceSlices, progress, trace
from flowtex.examples import double_gyre_field, vortex_field
from flowtex.trace import SliceStore, paths

Floats = NDArray[np.float64]


@pytest.fixture(scope="module")
def slices() -> TraceSlices:
    return trace(double_gyre_field(shape=(21, 41)), lags=[0.25, 1.0, 4.0])


# --- figures 3 and 4 ------------------------------------------------------------------------


def errors(field: FlowField, factor: int, lags: Floats, step: int) -> tuple[Floats, Floats]:
    """Mean error in cells, by lag, of down-sampled slices and of slices of the down-sampled field.

    What is compared, as in section 5 of the paper, is the position from which a particle at the
    middle of a block of nodes, or at a node that was kept, has come.
    """
    full = trace(field, lags=lags, parameter="time", unit=1.0, steps=[step], compose=False)
    small = full.downsample(factor)
    from_slices = small.nodes + small.displacement[0]
    exact = paths(field, small.nodes.reshape(-1, 2), lags, parameter="time", step=step).positions
    by_slices = np.linalg.norm(from_slices.reshape(len(lags), -1, 2) - exact, axis=-1).mean(axis=1)

    coarse = trace(
        field.downsample(factor), lags=lags, parameter="time", unit=1.0, steps=[step], compose=False
    )
    kept = full.displacement[0, :, ::factor, ::factor]
    rows, columns = (min(a, b) for a, b in zip(coarse.shape, kept.shape[1:3], strict=True))
    moved = coarse.displacement[0, :, :rows, :columns] * factor
    by_field = np.linalg.norm(moved - kept[:, :rows, :columns], axis=-1).mean(axis=(1, 2))
    return by_slices, by_field


@pytest.mark.parametrize("factor", [2, 4])
def test_figures_3_and_4_on_the_vortex(factor: int) -> None:
    field = vortex_field()
    lags = np.arange(1, 11) * 0.04
    by_slices, by_field = errors(field, factor, lags, step=10)
    # Averaging a block displaces its middle by an eighth of the second difference at most:
    # a bound in cells that does not follow from the lag.
    assert by_slices.max() < {2: 0.2, 4: 1.0}[factor]
    assert (by_slices[1:] < by_field[1:]).all()
    assert by_field[-1] > 2 * by_slices[-1]
    # The field's error grows from the start; the more, the coarser.
    assert (np.diff(by_field) > 0).all()
    assert by_field[-1] - by_field[0] > 2 * (by_slices[-1] - by_slices[0])


def test_figures_3_and_4_on_the_double_gyre() -> None:
    field = double_gyre_field(True, shape=(51, 101))
    lags = np.arange(1, 11) * 0.5
    by_slices, by_field = errors(field, 4, lags, step=30)
    assert by_slices.max() < 0.2
    assert by_field[-1] > 2 * by_slices[-1]


def test_a_coarser_field_errs_more_and_coarser_slices_hardly() -> None:
    field, lags = vortex_field(), np.array([0.4])
    two, four = (errors(field, factor, lags, step=10) for factor in (2, 4))
    assert four[1] - two[1] > 2 * (four[0] - two[0])


# --- one set of slices ----------------------------------------------------------------------


def test_slopes_at_lag_zero_are_the_rates(slices: TraceSlices) -> None:
    for forward, sign in ((False, -1), (True, 1)):
        slope = (slices.positions(1e-6, forward=forward) - slices.nodes) / 1e-6
        np.testing.assert_allclose(slope, sign * slices.rate[0], atol=1e-4)


def test_positions_at_the_slices_are_the_slices(slices: TraceSlices) -> None:
    inside = slices.reach[0] >= 4.0
    for m, lag in enumerate(slices.lags):
        expected = slices.nodes + slices.displacement[0, m]
        np.testing.assert_allclose(slices.positions(lag)[inside], expected[inside], atol=1e-5)
    assert inside.sum() > 500


def test_positions_at_lag_zero_are_the_nodes(slices: TraceSlices) -> None:
    np.testing.assert_array_equal(slices.positions(0.0), slices.nodes)


def test_positions_between_the_slices_lie_on_the_path(slices: TraceSlices) -> None:
    lag, inside = 2.0, slices.reach[0] >= 4.0
    field = double_gyre_field(shape=(21, 41))
    start = slices.nodes[inside]
    exact = paths(field, start, [lag * field.surface.cell_size[0, 0]]).positions[0]
    away = np.linalg.norm(slices.positions(lag)[inside] - exact, axis=-1)
    assert np.median(away) < 0.05


def test_positions_beyond_the_slices_are_refused(slices: TraceSlices) -> None:
    with pytest.raises(ValueError, match=r"^lag is 4\.5; expected 0 to 4, the lag of the last"):
        slices.positions(4.5)
    with pytest.raises(ValueError, match=r"^lag is -1; expected 0 to 4"):
        slices.positions(-1)


def test_forward_positions_need_forward_slices() -> None:
    one_sided = trace(double_gyre_field(shape=(6, 11)), two_sided=False)
    assert one_sided.forward is None
    with pytest.raises(ValueError, match="^there are no forward slices: trace a steady field with"):
        one_sided.positions(0.1, forward=True)


def test_downsampled_slices_stand_at_the_middle_of_their_blocks(slices: TraceSlices) -> None:
    small = slices.downsample(4)
    assert small.shape == (5, 10)
    np.testing.assert_allclose(small.nodes[0, 0], [1.5, 1.5])
    np.testing.assert_allclose(small.nodes[-1, -1], [37.5, 17.5])
    np.testing.assert_allclose(
        small.displacement[0, 1, 2, 3],
        slices.displacement[0, 1, 8:12, 12:16].mean(axis=(0, 1)),
        rtol=1e-5,
    )
    np.testing.assert_array_equal(slices.downsample(1).displacement, slices.displacement)


@pytest.mark.parametrize("factor", [0, -1, 22])
def test_downsampling_that_leaves_nothing_is_refused(slices: TraceSlices, factor: int) -> None:
    with pytest.raises(ValueError, match=rf"^factor is {factor}; expected 1 to 21, the shorter"):
        slices.downsample(factor)


def test_one_step_of_several() -> None:
    whole = trace(double_gyre_field(True, shape=(6, 11)))
    for step in (0, 7, -1):
        one = whole.at_step(step)
        np.testing.assert_array_equal(one.displacement[0], whole.displacement[step])
        assert one.times.tolist() == [whole.times[step]]


def test_repr_tells_the_sizes(slices: TraceSlices) -> None:
    assert re.fullmatch(
        r"TraceSlices\(41 x 21 nodes \(I x J\), 1 destination times, 3 lags by arclength, "
        r"backward and forward, \d\.\d MB\)",
        repr(slices),
    )


# --- files ----------------------------------------------------------------------------------


@pytest.mark.parametrize("two_sided", [True, False])
def test_saved_slices_are_read_back(tmp_path: Path, two_sided: bool) -> None:
    before = trace(double_gyre_field(shape=(6, 11)), two_sided=two_sided)
    before.save(tmp_path / "slices.npz")
    after = TraceSlices.open(tmp_path / "slices.npz")
    for name in TraceSlices.__dataclass_fields__:
        one, two = getattr(before, name), getattr(after, name)
        if isinstance(one, np.ndarray):
            assert one.dtype == two.dtype
            np.testing.assert_array_equal(one, two)
        else:
            assert one == two


class Trap:
    """Writes a file when it is unpickled."""

    def __init__(self, path: Path) -> None:
        self.path = path

    def __reduce__(self) -> tuple[object, ...]:
        return Path.touch, (self.path,)


def broken(path: Path, kind: str) -> None:
    good = path.with_name("good.npz")
    trace(double_gyre_field(shape=(6, 11))).save(good)
    data = good.read_bytes()
    if kind == "text":
        path.write_text("lags,1,2")
    elif kind == "empty":
        path.write_bytes(b"")
    elif kind == "cut":
        path.write_bytes(data[: len(data) // 2])
    elif kind == "array":
        with path.open("wb") as file:
            np.save(file, np.zeros(3))
    elif kind == "other arrays":
        np.savez(path, lags=np.zeros(3))
    elif kind == "arrays missing":
        np.savez(path, format=np.array("flowtex-slices-1"), lags=np.zeros(3))
    elif kind == "damaged":
        middle = len(data) // 2
        path.write_bytes(data[:middle] + bytes(64) + data[middle + 64 :])
    else:
        trap = np.array([Trap(path.with_name("sprung"))], dtype=object)
        np.savez(path, format=np.array("flowtex-slices-1"), lags=trap, allow_pickle=True)


@pytest.mark.parametrize(
    "kind",
    ["text", "empty", "cut", "array", "other arrays", "arrays missing", "damaged", "pickle"],
)
def test_files_of_another_kind_are_refused(tmp_path: Path, kind: str) -> None:
    path = tmp_path / "slices.npz"
    broken(path, kind)
    expected = f"{path} does not hold trace slices; expected a file that TraceSlices.save wrote"
    with pytest.raises(ValueError, match=f"^{re.escape(expected)}$"):
        TraceSlices.open(path)
    assert not (tmp_path / "sprung").exists()


def test_a_missing_file_is_told_as_such(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError):
        TraceSlices.open(tmp_path / "none.npz")


# --- arguments ------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "lags", [[], [0.0, 1.0], [-1.0], [2.0, 1.0], [1.0, 1.0], [1.0, np.inf], [np.nan], [[1.0, 2.0]]]
)
def test_lags_that_do_not_increase_are_refused(lags: list[float]) -> None:
    message = f"lags is {lags!r}; expected positive numbers in increasing order"
    field = double_gyre_field(shape=(6, 11))
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        trace(field, lags=lags)
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        paths(field, [[1.0, 1.0]], lags)


def test_other_arguments_are_checked() -> None:
    field = double_gyre_field(shape=(6, 11))
    message = 'parameter is \'length\'; expected "arclength" or "time"'
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        trace(field, parameter="length")
    message = "unit has values from -1 to -1; expected positive numbers"
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        trace(field, unit=-1.0)
    message = "tolerance is 0; expected a positive number of cells, such as 1e-3"
    with pytest.raises(ValueError, match=f"^{re.escape(message)}$"):
        trace(field, tolerance=0)
    with pytest.raises(IndexError, match="^time step 1 does not exist: expected 0 to 0$"):
        trace(field, steps=[1])


def test_a_time_varying_field_is_followed_by_time() -> None:
    assert trace(double_gyre_field(True, shape=(6, 11))).parameter == "time"


def test_unit_scales_the_lags() -> None:
    field = double_gyre_field(shape=(11, 21))
    one = trace(field, lags=[1.0, 4.0], unit=0.05)
    two = trace(field, lags=[2.0, 8.0], unit=0.025)
    np.testing.assert_allclose(one.displacement, two.displacement, atol=1e-4)
    np.testing.assert_allclose(one.reach, two.reach / 2, rtol=1e-4)


def test_automatic_lags_of_a_time_varying_field_reach_its_steps() -> None:
    for field in (vortex_field(), double_gyre_field(True, shape=(21, 41))):
        lags = trace(field, steps=[0]).lags
        step = np.diff(field.times)[0]
        np.testing.assert_allclose(np.log2(lags / step) % 1, 0, atol=1e-6)
        assert lags[0] <= step < lags[-1]


# --- progress, and the store ----------------------------------------------------------------


def bars_drawn(monkeypatch: pytest.MonkeyPatch, seconds: float, *, show: bool = True) -> int:
    drawn: list[str] = []

    class Bar:
        def __init__(self, text: str, total: int) -> None:
            drawn.append(text)

        def move(self, done: int) -> None:
            pass

        def close(self, total: int) -> None:
            drawn.append("closed")

    clock = iter(np.arange(0, 1000 * seconds, seconds))
    monkeypatch.setattr(progress.time, "monotonic", lambda: float(next(clock)))
    monkeypatch.setattr(progress, "_Bar", Bar)
    trace(double_gyre_field(True, shape=(6, 11)), progress=show)
    assert drawn in ([], ["Tracing", "closed"])
    return len(drawn)


def test_a_progress_bar_appears_after_a_second(monkeypatch: pytest.MonkeyPatch) -> None:
    assert bars_drawn(monkeypatch, 0.3)


def test_no_progress_bar_for_short_work(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not bars_drawn(monkeypatch, 0.001)


def test_no_progress_bar_when_it_is_not_wanted(monkeypatch: pytest.MonkeyPatch) -> None:
    assert not bars_drawn(monkeypatch, 0.3, show=False)


def test_store_gives_each_step_once() -> None:
    field = double_gyre_field(True, shape=(11, 21))
    store = SliceStore(field)
    one = store.at(5)
    assert store.at(5) is one
    assert one.times.tolist() == [field.times[5]]
    np.testing.assert_allclose(one.displacement, trace(field).at_step(5).displacement, atol=1e-6)
