# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# Records (see groups.bash) -> the table at the end of ./run test. Exit status 1 when anything failed.
# size: short, full or campaign; seconds: wall time; required: value of PICOLO_REQUIRE.

BEGIN { FS = "\t" }
{
  group = $1
  if (!(group in known)) { known[group] = 1; order[++groups] = group }
  time[group] += $4
  if ($3 == "built") { next }
  ++tests[group]
  ++count[group, $3]
  ++total[$3]
  if ($3 == "failed") { failures[++failed_tests] = $2 (index(group, " ") ? " (" group ")" : "") ": " $5 }
  if ($3 == "skipped") { if (!($5 in skips)) { reasons[++kinds] = $5 } ++skips[$5] }
}

# A required group must have run; `data` is not a group: tests that miss their data fail by themselves.
function check_required(    names, n, i, required_group) {
  n = split(required, names, ",")
  for (i = 1; i <= n; ++i) {
    if (names[i] == "" || names[i] == "data") { continue }
    required_group = names[i] == "arm" ? "target" : names[i]
    if (count[required_group, "passed"] + 0 == 0 || count[required_group, "skipped"] + 0 > 0) {
      failures[++failed_tests] = "PICOLO_REQUIRE: group " names[i] " did not run completely"
      ++total["failed"]
    }
  }
}

END {
  check_required()
  printf "\n%-28s %7s %7s %7s %7s %9s\n", "group", "tests", "passed", "failed", "skipped", "seconds"
  for (i = 1; i <= groups; ++i) {
    group = order[i]
    if (!(group in tests)) { printf "%-28s %39.0f\n", group, time[group]; continue }
    printf "%-28s %7d %7d %7d %7d %7.1f\n", group, tests[group], count[group, "passed"],
           count[group, "failed"], count[group, "skipped"], time[group]
  }
  printf "%-28s %7d %7d %7d %7d %7.0f (wall)\n", "total",
         total["passed"] + total["failed"] + total["skipped"], total["passed"], total["failed"],
         total["skipped"], seconds
  for (i = 1; i <= failed_tests; ++i) { print "FAILED " failures[i] }
  for (i = 1; i <= kinds; ++i) { printf "skipped %d: %s\n", skips[reasons[i]], reasons[i] }
  if (size == "short") {
    print "left out: slow tests, other platforms (./run test --full); other compilers, sanitizers, fuzzing, lint (--campaign)"
  }
  printf "%d passed, %d failed, %d skipped\n", total["passed"], total["failed"], total["skipped"]
  exit (total["failed"] > 0 || total["passed"] + 0 == 0) ? 1 : 0
}
