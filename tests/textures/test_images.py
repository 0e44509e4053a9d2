"""Images in place of the noise."""

from __future__ import annotations

from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image
from scipy.ndimage import map_coordinates, uniform_filter

import flowtex
from flowtex import FlowField
from flowtex._util.array_types import AnyArray, Bools, Bytes, Floats
from flowtex.textures.images import LARGEST, ImageError, as_picture, load_image

SIZE = (240, 140)


@cache
def uniform(u: float = 1.0, v: float = 0.0, steps: int = 1) -> FlowField:
    """A flow that is the same everywhere on 0 ... 2 by 0 ... 1."""
    y, x = np.mgrid[0:1:11j, 0:2:21j]
    velocity = np.broadcast_to([u, v], (steps, *x.shape, 2))
    times = None if steps == 1 else np.arange(steps) * 1.0
    points = np.stack([x, y], axis=-1)
    return FlowField.from_arrays(points, velocity, times=times, periodic="")


@cache
def gyre() -> FlowField:
    y, x = np.mgrid[0:1:31j, 0:2:61j]
    u = -np.sin(np.pi * x) * np.cos(np.pi * y)
    v = np.cos(np.pi * x) * np.sin(np.pi * y)
    return FlowField.from_arrays(np.stack([x, y], -1), np.stack([u, v], -1), periodic="")


@cache
def still() -> FlowField:
    with pytest.warns(UserWarning, match="velocity is zero at every node"):
        return uniform(0.0)


def photo(rng: np.random.Generator, height: int = 64, width: int = 128) -> Bytes:
    """Blobs of all colours, (H, W, 3)."""
    colours = rng.uniform(0, 255, (height, width, 3))
    blobs = uniform_filter(colours, (height // 8, width // 16, 0))
    low, high = blobs.min(axis=(0, 1)), blobs.max(axis=(0, 1))
    return np.asarray(255 * (blobs - low) / (high - low)).astype(np.uint8)


def draw(field: FlowField, **options: Any) -> Floats:
    return flowtex.render(field, **{"size": SIZE, **options}).astype(float)


def places() -> tuple[Floats, Floats, Bools]:
    """Coordinates of the middles of the pixels, and whether they lie well inside 2 by 1."""
    width, height = SIZE
    scale = max(1.0, 2.0 * height / width) / 0.92 / height
    x = 1 + (np.arange(width) + 0.5 - width / 2) * scale
    y = 0.5 - (np.arange(height) + 0.5 - height / 2) * scale
    x, y = np.meshgrid(x, y)
    return x, y, (np.abs(x - 1) < 0.98) & (np.abs(y - 0.5) < 0.48)


def seen(image: AnyArray, x: Floats, y: Floats) -> Floats:
    """Values of an image that is laid over 2 by 1, row 0 at the top, interpolated bilinearly."""
    height, width = image.shape[:2]
    at = [(1 - y) * height - 0.5, x / 2 * width - 0.5]
    channels = np.moveaxis(image.astype(float), -1, 0)
    return np.stack([map_coordinates(c, at, order=1, mode="nearest") for c in channels], axis=-1)


# --- what comes in --------------------------------------------------------------------------


def test_an_image_becomes_colours_times_opacity_with_its_bottom_first() -> None:
    image = np.zeros((2, 3, 4), np.uint8)
    image[0, 0] = [255, 51, 0, 102]
    picture = as_picture(image)
    assert picture.shape == (2, 3, 4) and picture.dtype == np.float32
    np.testing.assert_allclose(picture[1, 0], [0.4, 0.08, 0, 0.4], atol=1e-6)
    assert not picture[0].any()


@pytest.mark.parametrize(
    "image",
    [
        np.array([[255, 0]], np.uint8),
        np.array([[65535, 0]], np.uint16),
        np.array([[1.0, 0.0]]),
        np.array([[1.0, 0.0]], np.float16),
        np.array([[True, False]]),
        np.array([[[1.0] * 3, [0.0] * 3]]),
        [[[1.0, 1.0, 1.0, 1.0], [0.0, 0.0, 0.0, 1.0]]],
    ],
)
def test_every_kind_of_numbers_and_shape_is_taken(image: Any) -> None:
    np.testing.assert_array_equal(as_picture(image), [[[1, 1, 1, 1], [0, 0, 0, 1]]])


def test_an_image_that_is_too_large_is_averaged_down() -> None:
    image = np.zeros((3, 2 * LARGEST), np.uint8)
    image[:, ::2] = 255
    picture = as_picture(image)
    assert picture.shape == (2, LARGEST, 4)
    np.testing.assert_allclose(picture[..., :3], 0.5)


def test_files_are_read_as_they_look(tmp_path: Path, rng: np.random.Generator) -> None:
    image = photo(rng, 16, 24)
    Image.fromarray(image).save(tmp_path / "a.png")
    np.testing.assert_array_equal(load_image(tmp_path / "a.png"), image)
    Image.fromarray(image).save(tmp_path / "a.jpg", quality=95, subsampling=0)
    assert np.abs(load_image(str(tmp_path / "a.jpg")).astype(float) - image).mean() < 4
    Image.fromarray(image[..., 0]).save(tmp_path / "grey.png")
    np.testing.assert_array_equal(
        as_picture(load_image(tmp_path / "grey.png")), as_picture(image[..., 0])
    )
    deep = (image[..., 0].astype(np.uint16) << 8) + 7
    Image.fromarray(deep).save(tmp_path / "deep.png")
    np.testing.assert_array_equal(load_image(tmp_path / "deep.png"), deep)
    # Orientation 6 of a camera: to be turned by a quarter to the right.
    turned = Image.Exif()
    turned[0x0112] = 6
    Image.fromarray(image).save(tmp_path / "turned.png", exif=turned)
    np.testing.assert_array_equal(load_image(tmp_path / "turned.png"), np.rot90(image, -1))
    see_through = np.dstack([image, image[..., :1]])
    Image.fromarray(see_through).save(tmp_path / "dye.png")
    np.testing.assert_array_equal(load_image(tmp_path / "dye.png"), see_through)


def test_files_that_cannot_be_read_are_told(tmp_path: Path, rng: np.random.Generator) -> None:
    (tmp_path / "text.png").write_text("no picture")
    Image.fromarray(photo(rng)).save(tmp_path / "whole.png")
    (tmp_path / "cut.png").write_bytes((tmp_path / "whole.png").read_bytes()[:900])
    for name, told in (
        ("none.png", r"none.png: the file does not exist; expected a picture"),
        (".", r": is a folder; expected a picture"),
        ("text.png", r"text.png: the picture cannot be read"),
        ("cut.png", r"cut.png: the picture cannot be read \(.+\); expected"),
    ):
        with pytest.raises(ImageError, match=told):
            load_image(tmp_path / name)


# --- pictures along the flow ----------------------------------------------------------------


@pytest.mark.parametrize("lod", [True, False])
def test_without_flow_an_image_is_itself_with_its_top_up(
    opengl: Any, rng: np.random.Generator, lod: bool
) -> None:
    image = photo(rng)
    x, y, inside = places()
    found = draw(still(), image=image, lod=lod)
    # The level of detail may average a pixel of the picture with the next.
    assert np.abs(found - seen(image, x, y))[inside].max() < (12 if lod else 3)
    assert np.abs(found - seen(image[::-1], x, y))[inside].mean() > 20


@pytest.mark.parametrize("along", ["i", "j"])
def test_a_uniform_flow_blurs_along_itself_alone(
    opengl: Any, rng: np.random.Generator, along: str
) -> None:
    """The kernel written out: a mean of Hann weights over points that are one step apart."""
    image = photo(rng)
    x, y, inside = places()
    samples, spacing = 21, 8.0
    u, v = (1.0, 0.0) if along == "i" else (0.0, 1.0)
    found = draw(uniform(u, v), image=image, samples=samples, spacing=spacing, lod=False)
    # A step is eight texels, of which there are 1024 along x and 512 along y.
    k = np.arange(-10, 11)
    weight = 0.5 + 0.5 * np.cos(np.pi * k / 11)
    way = k * spacing * 2 / 1024
    terms = [w * seen(image, x + s * u, y + s * v) for w, s in zip(weight, way, strict=True)]
    expected = np.sum(terms, axis=0) / weight.sum()
    reach = float(way.max()) + 0.01
    clear = inside & (np.abs(x - 1) < 1 - reach * u) & (np.abs(y - 0.5) < 0.5 - reach * v)
    assert clear.sum() > 5000
    assert np.abs(found - expected)[clear].max() < 4
    assert np.abs(found - seen(image, x, y))[clear].mean() > 10


@pytest.mark.parametrize("steps", [1, 2])
def test_colours_survive_also_on_a_curved_surface_in_the_light(opengl: Any, steps: int) -> None:
    red = np.zeros((5, 9, 3))
    red[..., 0] = 1.0
    found = draw(uniform(1, 0.3, steps), image=red)
    assert (found[places()[2]] == [255, 0, 0]).all()
    angle, height = np.meshgrid(np.linspace(0, 2, 41), np.linspace(0, 1, 21))
    points = np.stack([np.cos(angle), np.sin(angle), height], axis=-1)
    along = np.stack([-np.sin(angle), np.cos(angle), 0 * angle], axis=-1)
    times = None if steps == 1 else np.arange(steps)
    field = FlowField.from_arrays(points, np.stack([along] * steps), times=times, periodic="")
    found = draw(field, image=red, background="black")
    assert (found[..., 0] > 100).mean() > 0.03
    assert found[..., 1:].max() < 2


def test_dye_lies_on_the_colour_of_the_surface(opengl: Any) -> None:
    dye = np.zeros((32, 64, 4))
    dye[..., 1] = 1.0  # green that is not seen where it is transparent
    dye[:, 32:, 3] = 0.5
    found = draw(uniform(0.0, 1.0), image=dye, scalars=False, color=(1.0, 0.0, 0.0))
    x, _, inside = places()
    np.testing.assert_allclose(found[inside & (x < 0.9)].mean(axis=0), [255, 0, 0], atol=1)
    np.testing.assert_allclose(found[inside & (x > 1.1)].mean(axis=0), [127.5, 127.5, 0], atol=1.5)
    # So does a whole image by the strength.
    blue = np.zeros((4, 4, 3))
    blue[..., 2] = 1.0
    found = draw(uniform(), image=blue, strength=0.25, scalars=False, color=(1.0, 0.0, 0.0))
    np.testing.assert_allclose(found[inside].mean(axis=0), [191.25, 0, 63.75], atol=1)


def test_tiles_repeat_the_image(opengl: Any, rng: np.random.Generator) -> None:
    image = photo(rng, 32, 64)
    one = draw(gyre(), image=np.tile(image, (3, 3, 1)))
    three = draw(gyre(), image=image, tiles=3)
    assert np.abs(one - three)[places()[2]].max() < 3
    assert np.abs(draw(gyre(), image=image) - three).mean() > 10


def test_nothing_comes_over_from_the_opposite_edge(opengl: Any) -> None:
    image = np.zeros((16, 32), np.uint8)
    image[:, 0] = 255
    found = draw(still(), image=image)
    x, _, _ = places()
    inside = np.abs(places()[1] - 0.5) < 0.45
    assert found[inside & (x > 1.9) & (x < 1.995)].max() < 2
    assert found[inside & (x < 0.02) & (x > 0.005)].min() > 250


def test_the_level_of_detail_keeps_a_fine_image_from_flickering(opengl: Any) -> None:
    fine = (np.indices((512, 1024)).sum(axis=0) % 2).astype(bool)
    _, _, inside = places()
    smooth, rough = (
        draw(uniform(), image=fine, samples=1, lod=lod)[inside] for lod in (True, False)
    )
    assert smooth.std() < 3
    assert smooth.mean() == pytest.approx(127.5, abs=2)
    assert rough.std() > 15


# --- live, and what cannot be ---------------------------------------------------------------


def test_another_image_is_shown_at_once_and_paths_are_not_sent_again(
    plotter: Any, rng: np.random.Generator
) -> None:
    image = photo(rng)
    handle = plotter.flowtex.add(gyre(), image=image)
    assert (handle.settings.noise, handle.settings.strength) == ("image", 1.0)
    assert len(plotter.scalar_bars) == 0
    first = plotter.screenshot(return_img=True)
    paths = handle.surface._base._gpu["u_slices"]
    handle.set_image(255 - image)
    second = plotter.screenshot(return_img=True)
    assert handle.surface._base._gpu["u_slices"] is paths
    inside = (first != 255).any(axis=-1) & (second != 255).any(axis=-1)
    assert inside.mean() > 0.4
    assert np.abs(first.astype(float) + second - 255)[inside].max() < 4
    handle.set_image(image)
    np.testing.assert_array_equal(plotter.screenshot(return_img=True), first)


def test_an_image_can_come_later_and_go_again(plotter: Any, rng: np.random.Generator) -> None:
    handle = plotter.flowtex.add(gyre(), show_scalar_bar=False)
    first = plotter.screenshot(return_img=True)
    handle.set_image(photo(rng))
    assert handle.settings.noise == "image"
    second = plotter.screenshot(return_img=True)
    assert np.abs(first.astype(float) - second).mean() > 10
    handle.settings.tiles = 4
    assert np.abs(plotter.screenshot(return_img=True).astype(float) - second).mean() > 5
    handle.settings.noise = "procedural"
    np.testing.assert_array_equal(plotter.screenshot(return_img=True), first)
