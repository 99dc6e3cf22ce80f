#!/bin/bash
# Submits a study as an array of shards and the job that joins them:
#
#   deploy/slurm/submit.sh SCENARIO OUT SHARDS [options of sbatch, for the array]
#
# Prints the numbers of both jobs.
set -euo pipefail

[ $# -ge 3 ] || { echo "usage: submit.sh SCENARIO OUT SHARDS [options of sbatch]" >&2; exit 2; }
scenario=$1 out=$2 shards=$3
shift 3
case $shards in
  *[!0-9]* | '' | 0) echo "submit.sh: SHARDS is '$shards', expected a number above 0" >&2; exit 2 ;;
esac
here=$(cd "$(dirname "$0")" && pwd)

array=$(sbatch --parsable --array="1-$shards" "$@" "$here/study.sbatch" "$scenario" "$out")
merge=$(sbatch --parsable --dependency="afterok:$array" "$here/merge.sbatch" "$out")
echo "array $array, merge $merge"
