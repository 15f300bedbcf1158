# SPDX-License-Identifier: BSD-3-Clause
"""What machine a measurement was made on: a folder name, a line of words, and whether it is busy."""
import os
import re
import subprocess
import sys
import time


def lscpu():
    text = subprocess.run(["lscpu"], capture_output=True, text=True, check=True, env={**os.environ, "LC_ALL": "C"})
    return {k.strip(): v.strip() for k, _, v in (line.partition(":") for line in text.stdout.splitlines())}


def name():
    """Such as epyc-25-17-avx512-2core, with the processor's family and model."""
    cpu = lscpu()
    model = cpu.get("Model name", "unknown").lower()
    family = re.search(r"epyc|xeon|ryzen|core|neoverse|graviton", model)
    flags = cpu.get("Flags", "").split()
    vectors = "avx512" if "avx512f" in flags else "avx2" if "avx2" in flags else cpu.get("Architecture", "unknown")
    kind = "-".join(filter(None, (family.group() if family else "cpu", cpu.get("CPU family"), cpu.get("Model"))))
    return f"{kind}-{vectors}-{cpu['CPU(s)']}core"


def words():
    cpu = lscpu()
    caches = ", ".join(f"{level} {cpu[key]}" for level, key in
                       (("L1d", "L1d cache"), ("L2", "L2 cache"), ("L3", "L3 cache")) if key in cpu)
    kind = f"{cpu.get('Model name')} (family {cpu.get('CPU family')}, model {cpu.get('Model')})"
    return f"{kind}, {cpu['CPU(s)']} cores, {caches}"


def revision():
    """Of the sources, such as 5644515 or 5644515-dirty; "unknown" without git. Documents and bench/results do not count."""
    def git(*words):
        return subprocess.run(["git", "-C", os.path.dirname(__file__), *words], capture_output=True, text=True).stdout.strip()
    changed = git("status", "--porcelain", "--untracked-files=no", "--", ":/", ":!/bench/results", ":!/*.md")
    return (git("describe", "--always") or "unknown") + ("-dirty" if changed else "")


def load():
    return os.getloadavg()[0]


def wait_until_idle(minutes, below=0.5):
    """Waits for the one-minute load to fall below a value; says whether it did."""
    end = time.time() + 60 * minutes
    while load() >= below and time.time() < end:
        print(f"load {load():.2f}, waiting for less than {below}", file=sys.stderr)
        time.sleep(10)
    return load() < below
