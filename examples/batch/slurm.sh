#!/bin/bash
#SBATCH --job-name=zerocount --open-mode=append
# A study in parts by an array job of Slurm, and a job that merges them when all have succeeded:
#     array=$(sbatch --parsable --array=1-64 --cpus-per-task=16 --time=2:00:00 slurm.sh study.yaml 64)
#     sbatch --dependency=afterok:$array --kill-on-invalid-dep=yes slurm.sh study.yaml 64
# The same commands again run what is missing. The number after the manifest is that of the parts; where it is larger
# than the array, an element runs several, one after the other.
set -u
study=$1 parts=$2
output=${study%.yaml}.h5
if [ -z "${SLURM_ARRAY_TASK_ID:-}" ]; then exec zerocount merge "$output.parts" --output "$output" --force; fi

mkdir -p "$output.parts"
status=0
trap 'stopped=yes' TERM INT  # the run ends by itself, and keeps what is finished
for ((part = SLURM_ARRAY_TASK_ID; part <= parts; part += SLURM_ARRAY_TASK_MAX)); do
  printf -v number "%0${#parts}d" "$part"
  zerocount run "$study" --quiet --threads "${SLURM_CPUS_PER_TASK:-1}" --shard "$part/$parts" \
    --output "$output.parts/part-$number-of-$parts.h5" || status=$?
  if [ "${stopped:-}" ] || [ "$status" -eq 130 ]; then break; fi
done
exit "$status"
