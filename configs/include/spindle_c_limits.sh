# SPDX-License-Identifier: GPL-2.0-or-later
# Connect C's travel to spindle_c.hal: [HAL] HALCMD = loadusr sh …/spindle_c_limits.sh
# Not in a HAL file: the pins are those of LinuxCNC's task, which starts after all of them.
for _ in $(seq 100); do
	halcmd show comp inihal | grep -q ready && break
	sleep 0.1
done
halcmd net spindle-c-least ini.c.min_limit && halcmd net spindle-c-most ini.c.max_limit
