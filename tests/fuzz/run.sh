#!/usr/bin/env bash
# Runs all packed fuzz targets, two processes each, and writes to OUTPUT_FOLDER: table.txt, the end of each target's log,
# the stack of each finding, and findings.tar.gz.
# usage: run.sh SECONDS OUTPUT_FOLDER [TARGET...]
set -uo pipefail

here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
readonly here
[[ $# -ge 2 ]] || { echo "usage: $0 SECONDS OUTPUT_FOLDER [TARGET...]" >&2; exit 2; }
readonly seconds=$1 output=$2
shift 2
mkdir -p "$output"
export LD_LIBRARY_PATH=$here/lib
if [[ ! -w $here ]]; then
  echo "$0: $here cannot be written: copy the folder first" >&2
  exit 2
fi
[[ -d /dev/shm && -w /dev/shm ]] && export TMPDIR=/dev/shm

# The leak sanitizer needs ptrace, and address sanitizers of that age fail where addresses are too random.
without_randomness=()
starts() { "${without_randomness[@]}" "$here/fuzz_manifest" -runs=1 >"$output/start.log" 2>&1; }
export ASAN_OPTIONS=detect_leaks=1
if ! starts; then without_randomness=(setarch -R); fi
if ! starts; then export ASAN_OPTIONS=detect_leaks=0; fi
if ! starts; then without_randomness=(); fi
if ! starts; then
  echo "the targets do not start here:" && tail -20 "$output/start.log"
  exit 2
fi
echo "ASAN_OPTIONS=$ASAN_OPTIONS ${without_randomness[*]}" | tee "$output/table.txt"

FUZZ_FOLDER=$here FUZZ_PROCESSES=2 FUZZ_TARGETS=16 FUZZ_UNCLASSIFIED=1 \
  "${without_randomness[@]}" "$here/fuzz" "$seconds" "$@" 2>&1 | tee -a "$output/table.txt"

# The stacks of at most 40 findings of each target.
for log in "$here"/findings/*.log; do
  target=$(basename "$log" .log)
  tail -c 20000 "$log" >"$output/$target.log"
  find "$here/findings/$target" -type f | head -40 | while read -r finding; do
    echo "== $(basename "$finding")"
    timeout 20 "${without_randomness[@]}" "$here/fuzz_$target" -timeout=10 "$finding" 2>&1 |
      grep -aE 'FINDING|ERROR|runtime error|^ *#[0-9]+ ' | head -20
  done >"$output/$target.stacks.txt"
done
cd "$here" && find findings -type f -not -name '*.log' | head -5000 | tar -czf "$output/findings.tar.gz" -T -
size=$(stat -c %s "$output/findings.tar.gz")
if [[ $size -gt 15000000 ]]; then
  find findings -type f -not -name '*.log' -size -4k | head -1000 | tar -czf "$output/findings.tar.gz" -T -
fi
tar -czf "$output/found.tar.gz" found
[[ $(stat -c %s "$output/found.tar.gz") -le 15000000 ]] || rm "$output/found.tar.gz"
exit 0
