#!/bin/bash
# Proves that a study split over a cluster gives the rows of one run, byte for byte, also when a task is killed in the middle.
#
# With Slurm installed (Debian: slurm-wlm; as root) a private one-node Slurm is started, used through the scripts of this
# folder and taken down again. Without it the same shards run as processes. Takes a quarter of a minute.
set -euo pipefail
root=$(cd "$(dirname "$0")/../.." && pwd)
here=$root/deploy/slurm
export STUDY=${STUDY:-$root/target/release/study}
[ -x "$STUDY" ] || { echo "test.sh: build the program first: cargo build --release -p study" >&2; exit 2; }
scenario=$here/one-node/study.toml
shards=6
work=$(mktemp -d)
out=$work/result

stop() {
  for name in slurmd slurmctld munged; do
    if [ -s "$work/$name.pid" ]; then kill "$(cat "$work/$name.pid")" 2> /dev/null || true; fi
  done
  sleep 0.5
  rm -rf "$work"
}
trap stop EXIT

# The first file that shard 2 writes, and the last: 79 blocks are 13 or 14 a shard.
first=$out/rows/0000-0013.parquet last=$out/rows/0000-0025.parquet

begun() {
  until [ -e "$first" ]; do sleep 0.05; done
}

killed() {
  [ ! -e "$last" ] || { echo "test.sh: shard 2 was over before it was killed" >&2; exit 1; }
}

refused() {
  if said=$("$STUDY" report "$out" --quiet 2>&1); then echo "test.sh: a page was made though trials are missing" >&2; exit 1; fi
  [[ $said == *"$out/rows/0000-00"*"is not stored"* ]] || { echo "test.sh: unexpected: $said" >&2; exit 1; }
}

same() {
  diff -r "$work/whole/rows" "$out/rows"
  [ -s "$out/report.html" ] || { echo "test.sh: there is no page" >&2; exit 1; }
  echo "test.sh: passed with $1: $shards shards, one of them killed, give the rows of one run"
}

has_slurm() {
  [ "$(id -u)" -eq 0 ] || return 1
  for program in sbatch srun scontrol slurmctld slurmd munged mungekey; do
    command -v "$program" > /dev/null || return 1
  done
}

start_slurm() {
  mkdir -p "$work/state" "$work/spool"
  chmod 755 "$work"
  mungekey --create --keyfile "$work/munge.key"
  munged --force --key-file "$work/munge.key" --socket "$work/munge.socket" --pid-file "$work/munged.pid" \
    --log-file "$work/munged.log" --seed-file "$work/munge.seed"
  sed -e "s|@HOST@|$(hostname -s)|g" -e "s|@STATE@|$work|g" -e "s|@CPUS@|$(nproc)|g" "$here/one-node/slurm.conf.in" > "$work/slurm.conf"
  export SLURM_CONF=$work/slurm.conf
  slurmctld -c
  slurmd -c
  for _ in $(seq 50); do
    sinfo -h -o %T 2> /dev/null | grep -q idle && return
    sleep 0.2
  done
  echo "test.sh: Slurm did not start; $(tail -3 "$work"/slurm*.log)" >&2
  return 1
}

wait_for() {
  while squeue -h -j "$1" 2> /dev/null | grep -q .; do sleep 0.3; done
}

"$STUDY" "$scenario" --out "$work/whole" --quiet

if has_slurm && start_slurm; then
  cd "$work"
  # As two arrays, the first of four.
  jobs=$(LARGEST=4 "$here/submit.sh" "$scenario" "$out" "$shards" --cpus-per-task=1 --time=10)
  echo "$jobs"
  array=${jobs#array } array=${array%%,*} array=${array// /,}
  report=${jobs##*report }
  # Kill the process of one task as a crash would, once it has stored something.
  begun
  # The folder is new, so no process but those of this task names it.
  pgrep -f -- "--shard 2/$shards --out $out " | xargs -r kill -KILL || true
  wait_for "$array"
  scancel "$report" 2> /dev/null || true
  killed
  refused
  # The array has failed in one task, so its report never runs; that task alone is submitted again.
  again=$(SHARDS=$shards sbatch --parsable --array=2 --cpus-per-task=1 --time=10 "$here/study.sbatch" "$scenario" "$out")
  wait_for "$again"
  wait_for "$(sbatch --parsable --dependency="afterok:$again" --time=10 --cpus-per-task=1 "$here/report.sbatch" "$out")"
  same Slurm
else
  # In the place of the shell that runs in the background, so that its number is the number of the program.
  run() { exec "$STUDY" "$scenario" --shard "$1/$shards" --out "$out" --threads 1 --quiet; }
  running=()
  for shard in $(seq "$shards"); do run "$shard" & running+=($!); done
  victim=${running[1]}
  begun
  kill -KILL "$victim"
  for process in "${running[@]}"; do
    wait "$process" 2> /dev/null || [ "$process" = "$victim" ]
  done
  killed
  refused
  (run 2)
  "$STUDY" report "$out" --quiet
  same processes
fi
