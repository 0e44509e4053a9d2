"""Where a store is: a local folder, ``s3://`` and other object storage, or ``http(s)://``.

Object storage takes endpoint and credentials from the environment alone. A place is written into
messages, titles and links, so one that carries a secret is refused, without repeating it.
"""

from __future__ import annotations

import json
import os
import platform
import re
import sys
import uuid
from collections.abc import AsyncIterator, Callable, Coroutine, Iterable, Iterator
from contextlib import contextmanager, suppress
from datetime import timedelta
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar
from urllib.parse import urlsplit

from flowtex._util.addresses import ADDRESS, data_advice
from flowtex._util.arguments import checked_path, checked_source
from flowtex.errors import FieldError, import_extra

if TYPE_CHECKING:
    from obstore.store import ObjectStore
    from zarr.abc.store import Store

T = TypeVar("T")
FORMAT = "flowtex-pyramid-6"  #: Format of every store; a reader refuses any other.
BUILDING = "building.json"  #: The object of a store that names the process which builds it.
DOCUMENT = "zarr.json"
_FILE_URL = re.compile(r"^file:/{1,3}(?=[^/])")
_WEB = ("http", "https")  #: Schemes of web servers.
_AZURE = ("abfs", "abfss", "adl", "az", "azure")  #: Schemes of Azure's storage.
_SCHEMES = ("s3", "s3a", "gs", *_AZURE, *_WEB)
SILENCE_S = 10.0  #: Seconds to wait for a server's answer.
CONNECT_S = 5.0  #: Seconds to wait for a connection.
MOST_REPEATS = 2  #: Times that a failed request is repeated.
FIRST_PAUSE_S = 0.2  #: Seconds before the first repetition.
MOST_NAMES = 5  #: Names of other data that a message lists.
LONGEST_S = 300.0  #: Longest transfer of one object in seconds.
_CREDENTIALS = (
    "credentials come from the environment, such as AWS_ACCESS_KEY_ID and AWS_SECRET_ACCESS_KEY, "
    "or AWS_SKIP_SIGNATURE=true for a public bucket"
)


class PyramidError(FieldError):
    """The store of a pyramid cannot be read or written.

    Examples
    --------
    >>> import flowtex
    >>> flowtex.pyramid.open_store("missing.zarr")
    Traceback (most recent call last):
    flowtex.pyramid.places.PyramidError: ...
    """


class DamageError(PyramidError):
    """A part of a store is missing or corrupt; a build makes it again."""


class ChangedError(PyramidError):
    """A store was built from other values than its source has now."""


class ReadFault(OSError):
    """An object that is ``missing``, or did not come; the text has no secret in it."""

    def __init__(self, text: str, *, missing: bool = False) -> None:
        super().__init__(text)
        self.missing = missing


def place_text(place: str | Path) -> str:
    """Return the URL of a store, or the whole path of a local one.

    Raises
    ------
    PyramidError
        When the address is no URL, has an unknown scheme, or contains a user, a password or a
        query.
    FieldError
        When a local path is invalid.
    """
    if not isinstance(place, str):
        text = str(checked_path("store", place))
    else:
        text = place
    if not ADDRESS.match(text):
        checked_path("store", text)
        return str(checked_source(_FILE_URL.sub("/", text)))
    url = ADDRESS.sub(r"\1://", text).replace("\\", "/")
    try:
        parts = urlsplit(url)
        user, _, host = parts.netloc.rpartition("@")
    except ValueError:
        raise PyramidError(
            "the address of the store is not a URL; expected one such as s3://bucket/flow.zarr"
        ) from None
    scheme = parts.scheme.lower()
    if scheme not in _SCHEMES:
        raise PyramidError(
            f"the store is at {scheme}://{host}{parts.path}; expected a folder, or an address "
            f"that starts with one of {', '.join(f'{name}://' for name in _SCHEMES)}"
        )
    # In addresses of Azure's the container stands where others have a user.
    secret = user and (scheme not in _AZURE or ":" in user)
    if secret or parts.query or parts.fragment:
        raise PyramidError(
            f"the address {scheme}://{host}{parts.path} contains a user, a password or a query; "
            "expected none: credentials come from the environment, such as AWS_ACCESS_KEY_ID"
        )
    return url.rstrip("/")


def is_remote(place: str | Path) -> bool:
    """Return whether a place is a URL."""
    return bool(ADDRESS.match(str(place)))


def objects_at(place: str | Path, *, patient: bool = False) -> ObjectStore:
    """Return the obstore store at a place.

    Parameters
    ----------
    place
        Folder, or URL of object storage.
    patient
        Whether failed requests are repeated for minutes, as builds need.

    Raises
    ------
    PyramidError
        When the place is not the address of a store.
    ModuleNotFoundError
        When obstore is not installed.
    """
    text = place_text(place)
    import_extra("obstore.store", "store")
    from obstore import store as objects

    if not is_remote(text):
        return objects.LocalStore(text)
    options: dict[str, Any] = {
        "client_options": {
            "allow_http": True,
            "connect_timeout": timedelta(seconds=CONNECT_S),
            "read_timeout": timedelta(seconds=SILENCE_S),
            "timeout": timedelta(seconds=LONGEST_S),
        }
    }
    if not patient:
        options["retry_config"] = {
            "max_retries": MOST_REPEATS,
            "retry_timeout": timedelta(seconds=LONGEST_S),
            "backoff": {"init_backoff": timedelta(seconds=FIRST_PAUSE_S)},
        }
    try:
        # from_url would take the addresses of some clouds for private buckets.
        if text.lower().startswith(_WEB):
            return objects.HTTPStore.from_url(text, **options)
        return objects.from_url(text, **options)
    except Exception as error:
        reason = str(error).partition("\n")[0]
        raise PyramidError(f"{text} is not the address of a store ({reason})") from None


def store_at(place: str | Path, *, read_only: bool = True) -> Store:
    """Return the Zarr store at a place, where files and objects are whole or absent.

    Its documents are checked as they are read, see :class:`CheckedStore`.

    Parameters
    ----------
    place
        Folder, or URL of object storage or of a web server.
    read_only
        Whether nothing is written.

    Raises
    ------
    PyramidError
        When the place is not the address of a store, or is on a web server and would be written.
    ModuleNotFoundError
        When Zarr is not installed.
    """
    text = place_text(place)
    import_extra("zarr.storage", "store")
    from zarr import storage

    from flowtex._util.zarr_stores import CheckedStore

    if not is_remote(text):
        return CheckedStore(storage.LocalStore(text, read_only=read_only))
    if read_only:
        return CheckedStore(storage.ObjectStore(objects_at(text), read_only=True))
    if text.lower().startswith(_WEB):
        raise PyramidError(
            f"{text} is read-only; build in a folder or in object storage such as s3://"
        )
    return CheckedStore(storage.ObjectStore(objects_at(text, patient=True)))


def sync(coroutine: Coroutine[Any, Any, T]) -> T:
    """Run a coroutine of a store of Zarr's, and return its result."""
    import_extra("zarr", "store")
    from flowtex._util.zarr_internals import sync as wait_for

    result: T = wait_for(coroutine)
    return result


def listed(names: Callable[[str], AsyncIterator[str]], prefix: str = "") -> list[str]:
    """Return the names that an asynchronous method of a store of Zarr's yields."""

    async def gathered() -> list[str]:
        return [name async for name in names(prefix)]

    return sync(gathered())


def is_store(place: object) -> bool:
    """Return whether a folder or URL contains a pyramid; a local one is checked without Zarr.

    Raises
    ------
    PyramidError
        When the kind of URL is not supported, it contains credentials, or the server does not
        answer.

    Examples
    --------
    >>> from flowtex.pyramid import is_store
    >>> is_store("flow.vts")
    False
    """
    if not isinstance(place, (str, Path)):
        return False
    text = place_text(place)
    try:
        is_url = is_remote(text)
        if is_url:
            document = _remote_document(text)
        else:
            document = (Path(text) / DOCUMENT).read_bytes()
        return "flowtex" in json.loads(document)["attributes"]
    except (OSError, ValueError, KeyError, TypeError) as error:
        if isinstance(error, PyramidError):
            raise
        return False


def _remote_document(text: str) -> bytes:
    """Return the metadata of a Zarr group at a URL; empty if the URL has no group."""
    obstore = import_extra("obstore", "store")
    try:
        return bytes(obstore.get(objects_at(text), DOCUMENT).bytes())
    except Exception as error:
        advice = data_advice(text)
        if advice:
            raise PyramidError(f"{text}: {advice}") from None
        # OPeNDAP and other services answer so to an unknown name.
        if isinstance(error, FileNotFoundError) or "status code: 400" in str(error):
            return b""
        raise PyramidError(f"{text}/{DOCUMENT} {fault_words(error)}") from None


def check_room(place: str, names: Iterable[str]) -> None:
    """Check that a build would not write among other data.

    Parameters
    ----------
    place
        Folder or URL.
    names
        Names of the entries at the place.

    Raises
    ------
    PyramidError
        When the place is a file, or contains other data than a pyramid.
    """
    if not is_remote(place) and Path(place).is_file():
        raise PyramidError(f"{place} is a file; expected a new or empty folder, or a store")
    others = sorted({*names} - {BUILDING})
    if others and not is_store(place):
        examples = ", ".join(others[:MOST_NAMES])
        if len(others) > MOST_NAMES:
            examples += ", …"
        raise PyramidError(
            f"{place} contains other data ({examples}); expected a new or empty folder, or a store"
        )


def is_refused(error: Exception) -> bool:
    """Return whether a store refused a request, as private ones do for missing objects."""
    refused = type(error).__name__ in ("PermissionDeniedError", "UnauthenticatedError")
    return refused or re.search(r"status code: 40[13]", str(error)) is not None


def fault_words(error: Exception) -> str:
    """Describe a failed request, without the server's text, which may contain secrets."""
    text = str(error)
    kind = type(error).__name__
    status = re.search(r"status code: (\d{3})", text)
    if is_refused(error):
        if status:
            code = status[1]
        else:
            code = "403"
        return f"is missing or access is denied ({code}); {_CREDENTIALS}"
    if isinstance(error, FileNotFoundError):
        return "is missing"
    if kind == "NotSupportedError":
        return "cannot be read in part: expected a server that supports range requests"
    if "169.254.169.254" in text:
        return f"cannot be read without credentials; {_CREDENTIALS}"
    if status:
        return f"could not be read: the server answered with status {status[1]}; try again later"
    if "kind: Timeout" in text or isinstance(error, TimeoutError):
        return f"could not be read: no answer within {SILENCE_S:g} s; check the server"
    if "kind: Connect" in text:
        return "could not be read: no server answers at this address; check the address"
    if "kind: Interrupted" in text or "kind: Body" in text:
        return "was cut off during transfer; try again"
    if isinstance(error, OSError):
        return f"cannot be read ({error.strerror or kind})"
    return f"could not be read ({kind})"


@contextmanager
def plain_faults() -> Iterator[None]:
    """Replace errors of object storage, which may repeat credentials, by short ones.

    Raises
    ------
    PyramidError
        When the ``with`` block raises an error of obstore. Other errors stay as they are.
    """
    try:
        yield
    except Exception as error:
        if not type(error).__module__.startswith("obstore"):
            raise
        raise PyramidError(f"the store {fault_words(error)}") from None


@contextmanager
def building(place: str) -> Iterator[None]:
    """Mark a store as being built, during a ``with`` block.

    Raises
    ------
    PyramidError
        When another build that still runs, or one on another machine, has marked it.
    """
    from zarr.buffer import default_buffer_prototype

    store = store_at(place, read_only=False)
    kind = default_buffer_prototype()
    host = platform.node()
    own = uuid.uuid4().hex
    for _ in range(2):
        text = json.dumps({"id": own, "host": host, "process": os.getpid()}).encode()
        mark = kind.buffer.from_bytes(text)
        holder = dict[str, Any]()
        try:
            sync(store.set_if_not_exists(BUILDING, mark))
        except (OSError, NotImplementedError):  # not all storage has links or conditional writes
            if sync(store.get(BUILDING, kind)) is None:
                sync(store.set(BUILDING, mark))
        with suppress(ValueError, TypeError):
            data = sync(store.get(BUILDING, kind))
            if data is None:
                holder = {}
            else:
                holder = {**json.loads(data.to_bytes())}
        if holder and (holder.get("host") != host or _is_running(holder.get("process"))):
            break
        sync(store.delete(BUILDING))  # it was cut off, or its process has ended
    if holder.get("id") != own:
        raise PyramidError(
            f"{place} is being built by process {holder.get('process', '?')} on "
            f"{holder.get('host', 'another machine')}; wait, or delete {BUILDING} if it has ended"
        )
    try:
        yield
    finally:
        with suppress(Exception):  # an error of the work inside is more important
            sync(store.delete(BUILDING))


def _is_running(process: object) -> bool:
    if sys.platform == "win32" or type(process) is not int:
        return True
    try:
        os.kill(process, 0)
    except OSError as error:
        return not isinstance(error, ProcessLookupError)
    return True
