from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest

from flowtex._util.memory import available_bytes

GB = 10**9


def machine(root: Path, files: dict[str, object]) -> Path:
    """Make the files that Linux has of a machine with 32 GB free."""
    files = {"proc/meminfo": f"MemTotal: 1 kB\nMemAvailable: {32 * GB // 1024} kB", **files}
    for name, text in files.items():
        (root / name).parent.mkdir(parents=True, exist_ok=True)
        (root / name).write_text(f"{text}\n")
    return root


@pytest.mark.parametrize("folder", ["", "/system.slice", "/system.slice/flow.service"])
def test_a_limit_of_any_group_above_counts(tmp_path: Path, folder: str) -> None:
    files = {
        "proc/self/cgroup": "0::/system.slice/flow.service",
        "sys/fs/cgroup/system.slice/flow.service/memory.max": "max",
        "sys/fs/cgroup/system.slice/flow.service/memory.current": GB,
        f"sys/fs/cgroup{folder}/memory.max": 3 * GB,
        f"sys/fs/cgroup{folder}/memory.current": 2 * GB,
        f"sys/fs/cgroup{folder}/memory.stat": f"anon 1\nactive_file {GB // 4}\ninactive_file 4",
    }
    assert available_bytes(machine(tmp_path, files)) == GB + GB // 4 + 4


def test_a_container_of_version_1_counts(tmp_path: Path) -> None:
    # The path is that of the host, and the container sees its own group at the top.
    files = {
        "proc/self/cgroup": "5:cpu:/docker/0af\n4:hugetlb,memory:/docker/0af\n0::/",
        "sys/fs/cgroup/memory/memory.limit_in_bytes": 2 * GB,
        "sys/fs/cgroup/memory/memory.usage_in_bytes": GB,
    }
    assert available_bytes(machine(tmp_path, files)) == GB


@pytest.mark.skipif(sys.platform != "linux", reason="other systems do not tell what is in use")
def test_a_limit_of_the_process_counts() -> None:
    code = (
        "import resource; from flowtex._util.memory import available_bytes\n"
        "resource.setrlimit(resource.RLIMIT_AS, (3 << 30, 3 << 30)); print(available_bytes())"
    )
    result = subprocess.run([sys.executable, "-c", code], capture_output=True, check=True)
    assert 0 < int(result.stdout) < 3 << 30
