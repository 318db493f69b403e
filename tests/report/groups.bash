# shellcheck shell=bash disable=SC2154 # variables of ./run
# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
# What `./run test` and `./run lint` do; sourced by ./run. Every result becomes one line of
# build/records.tsv: group, name, outcome (passed, failed, skipped, built), seconds, reason.

records=$root/build/records.tsv
report=$root/tests/report

record() { printf '%s\t%s\t%s\t%s\t%s\n' "$1" "$2" "$3" "$4" "${5:-}" >>"$records"; }

# Builds a preset as a row of the table; a build that fails is a failure, not the end.
build_row() {
  local start=$SECONDS
  say "run: building $1"
  if (build "$@"); then
    record "build $1" "$1" built $((SECONDS - start))
  else
    record "build $1" "$1" failed $((SECONDS - start)) "did not build, see build/$1/build.log"
    return 1
  fi
}

# ctest_rows PRESET SUFFIX CTEST_ARGS...: SUFFIX tells rows of the same group apart.
ctest_rows() {
  local preset=$1 suffix=$2 dir=$root/build/$1 code=0
  shift 2
  local name=${suffix// /-}
  local junit=$dir/junit$name.xml log=$dir/ctest$name.log
  rm -f "$junit"
  say "run: testing $preset$suffix"
  ctest --test-dir "$dir" --parallel "$jobs" --output-on-failure --test-output-size-passed 65536 \
    --output-junit "$junit" "$@" >"$log" 2>&1 || code=$?
  local before after
  before=$(grep -c $'\tfailed\t' "$records" || true)
  [[ -f $junit ]] && awk -v suffix="$suffix" -f "$report/junit.awk" "$junit" >>"$records"
  after=$(grep -c $'\tfailed\t' "$records" || true)
  if ((code != 0 && before == after)); then
    tail -n 20 "$log" >&2
    record "ctest$suffix" "$preset" failed 0 "ctest ended with $code, see ${log#"$root"/}"
  fi
}

run_lint() {
  need_packages "${packages_build[@]}" "${packages_full[@]}"
  configure host-clang # clang-tidy reads clang's flags better than gcc's
  cmake "$root/build/host-clang" >/dev/null # compile_commands.json of the tree as it is now
  mkdir -p "$root/build"
  (cd "$root" && "$report/lint" "$root/build/host-clang" "$jobs")
}

lint_row() {
  local start=$SECONDS
  say "run: lint"
  if run_lint >&2; then
    record lint all passed $((SECONDS - start))
  else
    record lint all failed $((SECONDS - start)) "see above, or call ./run lint"
  fi
}

# Presets whose images the group `target` runs, every platform of the one hash; in the short run the first one only.
image_presets=(target-m7 target-m4f target-m55 target-a53 target-aarch64
  image-gcc-O0 image-gcc-O2 image-gcc-O3 image-gcc-avx2
  image-clang-O0 image-clang-O2 image-clang-O3 image-clang-avx2)

# A whole calibration on two emulated boards by their own clock: minutes each; ./run targets and the campaign run it.
whole_calibration='Saving\.ACalibrationEnds'

has_arm() { command -v arm-none-eabi-g++ && command -v qemu-system-arm; } >/dev/null

# Builds images and names them in PICOLO_TARGETS for the tests that run them.
build_images() {
  local preset built=none
  for preset in "$@"; do
    if build_row "$preset"; then built+=,$preset; fi
  done
  export PICOLO_TARGETS=$built
}

run_targets() {
  need_packages "${packages_build[@]}" "${packages_arm[@]}" "${packages_targets[@]}"
  mkdir -p "$root/build"
  : >"$records"
  build_images "${image_presets[@]}"
  build host-release target_tests
  local test failed=0
  for test in "$root"/build/host-release/tests/target/*/test_target_*; do
    [[ -x $test && ! -d $test ]] || continue
    "$test" --gtest_brief=1 || failed=1
  done
  ! grep $'\tfailed\t' "$records" && return "$failed"
}

# The groups of a newcomer's run. The ARM packages are large: they are fetched while the host's part is built.
short_groups() {
  local fetching
  (need_packages "${packages_arm[@]}") >"$root/build/arm-packages.log" 2>&1 &
  fetching=$!
  build_row host-release || return 0
  if wait "$fetching" && has_arm; then
    build_images "${image_presets[0]}"
  else
    say "run: no ARM compiler or no QEMU (see build/arm-packages.log): the group target is skipped"
    export PICOLO_TARGETS=none
  fi
  # The work of every task takes whole drives on an emulated board: half a minute, with every platform.
  ctest_rows host-release "" --label-exclude '(^|-)slow(-|$)' --exclude-regex 'Work\.OfEveryTask'
}

# Executions, seconds and executions a second of every target, as they are printed by tests/fuzz/run_target.
fuzz_groups() {
  build_row host-fuzz picolo_fuzz || return 0
  ctest_rows host-fuzz " fuzz" --label-regex "$1"
  grep -ohE 'fuzz [a-z0-9-]+ +[0-9]+ executions.*second' "$root/build/host-fuzz/junit-fuzz.xml" | sort -u >&2 || true
}

# The test is there when its runtime was, at the time of configuring.
realtime_row() {
  if grep -qs '^PICOLO_RTSAN:FILEPATH=/' "$root/build/host-release/CMakeCache.txt"; then return; fi
  record integration realtime skipped 0 "no RealtimeSanitizer: Debian's libclang-rt-19-dev has it"
}

long_groups() {
  realtime_row
  if (need_packages "${packages_arm[@]}" "${packages_targets[@]}") && has_arm; then
    build_images "${image_presets[@]}"
    ctest_rows host-release " every-platform" --label-regex '^target$'
  else
    record "target every-platform" packages skipped 0 "packages for ARM could not be installed"
  fi
  ctest_rows host-release " slow" --label-regex '(^|-)slow(-|$)' --exclude-regex "$whole_calibration"
  local builds=(host-release)
  if build_row host-debug; then
    builds+=(host-debug)
    ctest_rows host-debug " host-debug" --label-regex '^(unit|property)(-|$)' --label-exclude '(^|-)slow(-|$)'
  fi
  compare_builds "${builds[@]}"
}

compare_builds() {
  say "run: comparing trajectories of $*"
  "$root/tests/determinism/compare_builds" "$root/build" "$tool" "$@" >>"$records"
}

# Hours: the other compiler, AVX2, the sanitizers, fuzzing, lint.
campaign_groups() {
  local builds=(host-release)
  if build_row host-clang; then
    builds+=(host-clang)
    ctest_rows host-clang " host-clang" --label-regex '^(unit|property)(-|$)' --label-exclude '(^|-)slow(-|$)'
  fi
  if grep -qs avx2 /proc/cpuinfo && build_row host-avx2 "$tool"; then builds+=(host-avx2); fi
  compare_builds "${builds[@]}"
  if build_row host-asan; then
    export UBSAN_OPTIONS=print_stacktrace=1
    ctest_rows host-asan " host-asan" \
      --label-regex '^(unit|property|drivers|ports|integration)(-|$)' --label-exclude '(^|-)slow(-|$)'
  fi
  ctest_rows host-release " whole-calibration" --tests-regex "$whole_calibration"
  fuzz_groups '^(fuzz|fuzz_long)$'
  lint_row
}

run_test() {
  local size=short option
  for option in "$@"; do
    case $option in
      --full) size=full ;;
      --campaign) size=campaign ;;
      *) die 2 "test does not know '$option'; it takes --full or --campaign" ;;
    esac
  done
  [[ $(uname -m) == x86_64 ]] || packages_vm=()
  need_packages "${packages_build[@]}" "${packages_vm[@]}"
  [[ $size == short ]] || need_packages "${packages_full[@]}"
  mkdir -p "$root/build"
  : >"$records"
  if [[ $size == campaign ]]; then
    export PICOLO_CAMPAIGN=10 # tests multiply their repetitions by this
    export RC_PARAMS=${RC_PARAMS:-"max_success=1000 seed=$RANDOM$RANDOM"}
    say "run: RC_PARAMS='$RC_PARAMS'"
  fi
  SECONDS=0
  # Packages that came since it was configured.
  [[ $size == short || ! -f $root/build/host-release/build.ninja ]] || cmake "$root/build/host-release" >/dev/null
  short_groups
  [[ $size == short ]] || long_groups
  [[ $size != campaign ]] || campaign_groups
  awk -v size="$size" -v seconds="$SECONDS" -v required="${PICOLO_REQUIRE:-}" \
    -f "$report/table.awk" "$records"
}
