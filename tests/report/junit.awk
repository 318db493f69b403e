# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# ctest's JUnit file -> records (see groups.bash). The group is what stands before the first '_' or '.'
# of a test's name (picolo_test sees to that) plus `suffix`. Output of failed tests goes to stderr.

function attribute(name,    start, rest) {
  start = index($0, " " name "=\"")
  if (start == 0) { return "" }
  rest = substr($0, start + length(name) + 3)
  return plain(substr(rest, 1, index(rest, "\"") - 1))
}

function plain(text) {
  gsub(/&lt;/, "<", text)
  gsub(/&gt;/, ">", text)
  gsub(/&quot;/, "\"", text)
  gsub(/&apos;/, "'", text)
  gsub(/&amp;/, "\\&", text)
  gsub(/\t/, " ", text)
  return text
}

/<testcase / {
  name = attribute("name")
  seconds = attribute("time")
  status = attribute("status")
  message = reason = output = ""
  lines = 0
  take_next = 0
}
/<(failure|skipped) / { message = attribute("message") }
/<\/testcase>/ {
  outcome = "passed"
  if (status == "disabled") { outcome = "skipped"; reason = "disabled" }
  if (status == "fail") {
    outcome = "failed"
    if (reason == "") { reason = message == "" ? "ended without a message" : message }
  }
  if (status == "notrun" && message ~ /^SKIP_/) { outcome = "skipped" }
  if (status == "notrun" && message !~ /^SKIP_/) { outcome = "failed"; reason = "not run: " message }
  if (outcome == "failed") { printf "---- %s%s\n%s", name, suffix, output > "/dev/stderr" }
  group = name
  sub(/[_.].*/, "", group)
  printf "%s%s\t%s\t%s\t%s\t%s\n", group, suffix, name, outcome, seconds, reason
}
{
  text = plain($0)
  if (lines < 60) { output = output text "\n"; ++lines }
  if (take_next && text !~ /^(Failed)?$/) { reason = (prefix == "" ? "" : prefix ": ") text; take_next = 0 }
  if (text ~ /: Skipped$/) { take_next = 1; prefix = "" }
  if (text ~ /: Failure$/ && reason == "") {
    take_next = 1
    prefix = text
    sub(/^.*\//, "", prefix)
    sub(/: Failure$/, "", prefix)
  }
}
