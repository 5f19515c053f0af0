#!/bin/bash
# A study in parts by GNU parallel, one on each core of this machine, or of other machines by ssh:
#     parallel.sh study.yaml 8 [HOST,HOST…]
# Over ssh the manifest goes to the folder zerocount in the home of each machine, and the parts come back.
# The names of the parts begin with the hash of the study: those of another manifest, or of an earlier one, stay aside.
set -euo pipefail
study=$1 parts=$2 hosts=${3:-:}
hash=$(zerocount check "$study" --hash)
part="parts/${hash:0:16}-{}-of-$parts.h5"

over_ssh=()
if [ "$hosts" != : ]; then over_ssh=(--sshlogin "$hosts" --workdir zerocount --transferfile "$study" --return "$part"); fi
# What is there is not asked for again: a machine of the list may not have it.
for number in $(seq "$parts"); do
  if [ ! -e "${part/\{\}/$number}" ]; then echo "$number"; fi
done | parallel "${over_ssh[@]}" --retries 3 mkdir -p parts '&&' \
  zerocount run "$(printf %q "$study")" --study "$hash" --quiet --threads 1 --shard "{}/$parts" -o "$part"
zerocount merge "parts/${hash:0:16}-"*"-of-$parts.h5" -o "${study%.yaml}.h5" --force
