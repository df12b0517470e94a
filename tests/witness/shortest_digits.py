# SPDX-License-Identifier: Apache-2.0
"""How many digits Python's repr, the shortest that reads back, needs for each double."""
from decimal import Decimal

from arrays import answer, given

answer("digits", [len(str(int("".join(map(str, Decimal(repr(v)).as_tuple().digits)))).rstrip("0")) or 1
                  for v in given("values").tolist()])
