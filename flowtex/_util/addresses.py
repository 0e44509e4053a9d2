"""Addresses of files and data servers, which flowtex does not read itself."""

from __future__ import annotations

import re
from pathlib import PurePosixPath
from urllib.parse import urlsplit

#: An address, also after ``pathlib`` has made a path of it, on Windows with backslashes. Addresses
#: of files are paths, and a single letter is a drive.
ADDRESS = re.compile(r"^(?!file:)([A-Za-z][A-Za-z0-9+.-]+):[/\\]{1,2}(?=[^/\\])")
#: The user and the password in an address.
_SECRET = re.compile(r"(?<=://)[^/@]*@")
#: Suffixes of files that xarray opens.
OF_XARRAY = re.compile(r"\.(nc[34]?|ncd|nc[ml]|cdf|netcdf|h5|hdf5?|gr(i)?b2?|jnl)$", re.IGNORECASE)
#: Suffixes of stores, which are read from their address.
OF_STORES = re.compile(r"\.zarr(\.zip)?$", re.IGNORECASE)
#: Parts of the addresses of OPeNDAP.
OPENDAP = re.compile(r"/(dodsC|dods|opendap|hyrax|griddap|dap[24]?)(/|$)", re.IGNORECASE)


def address_of(place: object) -> str:
    """Return an address with both of its slashes and without a password; empty for a path."""
    text = str(place)
    if not ADDRESS.match(text):
        return ""
    address = ADDRESS.sub(r"\1://", text).replace("\\", "/")
    return _SECRET.sub("", address)


def data_advice(address: str) -> str:
    """Return how data at an address are drawn; empty where it may be a Zarr store."""
    path = urlsplit(address).path
    suffix = PurePosixPath(path).suffix
    is_opendap = OPENDAP.search(path) is not None
    is_of_xarray = OF_XARRAY.search(path) is not None
    if OF_STORES.search(path) or not (is_opendap or is_of_xarray or suffix[1:2].isalpha()):
        return ""
    text = "only Zarr stores are read from their address. "
    opened = f'open the data with xarray, as in flowtex.show(xarray.open_dataset("{address}"))'
    copied = "Copy the file to this machine, and draw the copy"
    if address.lower().startswith("http"):
        copied = f"Download the file, as with curl -LO {address}, and draw the copy"
    if is_opendap:
        return f"{text}This is one of OPeNDAP: {opened}"
    if is_of_xarray:
        return f"{text}{copied}; or {opened}"
    return f"{text}{copied}"
