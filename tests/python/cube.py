# SPDX-License-Identifier: BSD-3-Clause
"""A cube of jelly whose underside is held."""

CUBE = {
    "duration": "1 s",
    "gravity": [0, 0, -9.81],
    "body": {
        "levels": [{"box": {"size": [0.1, 0.1, 0.1], "cells": [4, 4, 4]}}],
        "fixed": [{"half_space": {"normal": [0, 0, 1]}}],
    },
}
