#!/usr/bin/env bash
# Stands for the launcher in a page's folder, and for test programs there. The program is the one under test; after PAGE_SECONDS it gets Ctrl-C (later where it should
# end by itself), unless it is left running. Of builds and tests it is looked only whether there are such targets and tests.
program=$PAGE_BUILD/bin/tandem
[[ ${2:-} != --preset ]] || set -- "$1" "${@:4}"
fail() { echo "$*" >&2; exit 1; }
name=${0##*/}
if [[ $name == test_* ]]; then
  [[ -x $PAGE_BUILD/tests/$name ]] || exec ninja -C "$PAGE_BUILD" -t query "tests/$name"
  "$PAGE_BUILD/tests/$name" --gtest_list_tests "$@" | grep -q '^  ' || fail "no such test: $name $*"
  exit
fi
command=${1:-}
case $command in
  test)
    tests=$(cd "$PAGE_BUILD" && ctest -N "${@:2}" | sed -n 's/^Total Tests: //p')
    [[ $tests -gt 0 ]] || fail "no such test: $*"
    exit
    ;;
  build)
    case ${2:-} in
      module) set -- "tandem_module_$3" ;;
      plugin) set -- "$3" ;;
      *) set -- "${@:2}" ;;
    esac
    for target in "$@"; do ninja -C "$PAGE_BUILD" -t query "$target" >/dev/null || exit 1; done
    exit
    ;;
  format | package | docs) fail "./tandem $1 is not for a page's folder" ;;
  python)
    export PYTHONPATH=$PAGE_BUILD/python
    program=${TANDEM_PYTHON:-/usr/bin/python3}
    shift
    [[ ${1:-} != --wheel ]] || set -- -m tandem.wheel "${@:2}"
    ;;
esac
token=$(cat "$PAGE_ROOM/token" 2>/dev/null)
set -- "${@//token=…/token=$token}"
[[ -z ${PAGE_LEFT:-} ]] || exec "$program" "$@"
if [[ " $* " == *" --watch "* ]]; then # for a terminal
  words=$(printf '%q ' "$program" "$@")
  set -- -qefc "$words" /dev/null
  program=script
fi
case $command in
  bench | emulate | film | python | replay | robot | run | validate | view) seconds=$PAGE_SECONDS ;; # may take for ever, or nearly
  *) seconds=$((PAGE_SECONDS * 10)) ;;
esac
code=0
timeout --preserve-status --kill-after 30 --signal INT "$seconds" "$program" "$@" || code=$?
[[ $code -ne 130 ]] || code=0                     # ended by Ctrl-C
[[ $code -ne 4 || $command != compare ]] || code=0 # it has found a difference
exit "$code"
