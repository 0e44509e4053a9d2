"""A view among the text of a page of one's own: its scene as a script beside the page.

All views of a page share one copy of the client, ``core.js``, which loads a scene when its element
comes into sight::

    <script src="flowtex-live.js" defer></script>
    <div class="flowtex-live" data-scene="wake.js" style="height: 400px"></div>
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import ExitStack
from pathlib import Path
from typing import Any

from flowtex._util.whole_file import whole_file
from flowtex.host.export import contents_of, headers_text, json_text
from flowtex.host.view import WebView

#: Letters from which on a part has a script of its own, which scenes of the same flow share.
LETTERS_APART = 50_000


def write_scene(
    folder: Path,
    name: str,
    views: Sequence[WebView],
    *,
    camera: dict[str, Any] | None = None,
) -> None:
    """Write the script of a view, or of two beside each other, as ``name.js`` into a folder.

    Its large parts become scripts beside it, called by their digests. The camera is that of
    :meth:`ClientData.header`.
    """
    with ExitStack() as undo:
        with whole_file(folder / f"{name}.js") as file:
            file.writelines(text.encode() for text in _script(folder, name, views, camera, undo))
        undo.pop_all()


def _script(
    folder: Path,
    name: str,
    views: Sequence[WebView],
    camera: dict[str, Any] | None,
    undo: ExitStack,
) -> Iterator[str]:
    """Give the text of a scene; ``undo`` removes the parts that were written beside it."""
    contents = contents_of(views, camera=camera)
    headers = headers_text(contents.headers)
    yield f'flowtexScene({json_text(name)}, {{"headers": {headers}, "parts": ['
    for n, info, text in contents.parts:
        if len(text) > LETTERS_APART:
            digest = json_text(info["digest"])
            apart = folder / f"{info['digest']}.js"
            is_new = not apart.exists()
            with whole_file(apart) as file:
                file.write(f'flowtexPart({digest}, "{text}")\n'.encode())
            if is_new:
                undo.callback(apart.unlink)
            yield f"[{n}, {json_text(info)}, null],\n"
        else:
            yield f'[{n}, {json_text(info)}, "{text}"],\n'
    yield "]})\n"
