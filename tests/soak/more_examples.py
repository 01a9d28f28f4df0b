# SPDX-License-Identifier: GPL-2.0-or-later
"""A plugin of pytest: the properties of the normal tests are tried with far more examples.

Other ones each time; a failure is reduced by hypothesis and printed with what repeats it.
"""

from hypothesis import HealthCheck, settings

from soak import often

EXAMPLES = {"interp": 10_000, "unit": 1_000, "soak": 10_000}  # in ten minutes, by folder


def pytest_collection_modifyitems(items):
    for item in items:
        if hasattr(item.obj, "hypothesis"):
            item.obj._hypothesis_internal_use_settings = settings(
                max_examples=often(EXAMPLES[item.path.parent.name]),
                deadline=None,
                derandomize=False,
                database=None,
                print_blob=True,
                suppress_health_check=list(HealthCheck),
            )
