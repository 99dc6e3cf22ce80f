#!/bin/bash
# Submits a study as an array of shards, or several where Slurm allows no array of that size, and the job that makes its
# page:
#
#   deploy/slurm/submit.sh SCENARIO OUT SHARDS [options of sbatch, for the array]
#
# Prints the numbers of all jobs. With LARGEST=N no array has more than N tasks.
set -euo pipefail

[ $# -ge 3 ] || { echo "usage: submit.sh SCENARIO OUT SHARDS [options of sbatch]" >&2; exit 2; }
scenario=$1 out=$2 shards=$3
shift 3
case $shards in
  *[!0-9]* | '' | 0) echo "submit.sh: SHARDS is '$shards', expected a number above 0" >&2; exit 2 ;;
esac
here=$(cd "$(dirname "$0")" && pwd)

# The largest number of a task is one less than MaxArraySize.
allowed=$(scontrol show config 2> /dev/null | sed -n 's/^MaxArraySize *= *\([0-9]*\)$/\1/p' || true)
largest=${LARGEST:-$((${allowed:-1001} - 1))}
arrays=()
for ((offset = 0; offset < shards; offset += largest)); do
  tasks=$((shards - offset < largest ? shards - offset : largest))
  arrays+=("$(SHARDS=$shards OFFSET=$offset sbatch --parsable --array="1-$tasks" "$@" "$here/study.sbatch" "$scenario" "$out")")
done
all=$(IFS=:; echo "${arrays[*]}")
report=$(sbatch --parsable --dependency="afterok:$all" "$here/report.sbatch" "$out")
echo "array ${all//:/ }, report $report"
