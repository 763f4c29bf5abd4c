#!/usr/bin/env bash
# The same study through `fretwork study run`, Slurm, HyperQueue, Snakemake and a list of commands:
# all must give the same table.
# Usage: tests/engines/run.sh, from the root of the repository, after `cargo build --release`. On
# Debian or Ubuntu as root it installs what is missing: Slurm and munge by apt-get, Snakemake,
# HyperQueue and pandas with pip in a virtual environment below target/. It starts a Slurm of one
# machine (munged, slurmctld, slurmd) with its files in target/engines and stops it at the end.
# HyperQueue's package has its server and worker but no command `hq`: tasks of the exported file are
# submitted through its Python interface (hyperqueue_tasks.py); with `hq` in the PATH the file
# itself is submitted.
set -euo pipefail
cd "$(dirname "$0")/../.."
here="$PWD/tests/engines"
work="$PWD/target/engines"
program="${FRETWORK:-$PWD/target/release/fretwork}"
rm -rf "$work"
mkdir -p "$work"

if ! command -v slurmctld >/dev/null || ! command -v munged >/dev/null; then
    apt-get update -qq
    apt-get install -y -qq slurm-wlm munge >/dev/null
fi
python="$PWD/target/engines-venv/bin/python"
if ! "$python" -c "import hyperqueue, pandas, pyarrow, snakemake" 2>/dev/null; then
    python3 -m venv "$PWD/target/engines-venv"
    "$PWD/target/engines-venv/bin/pip" install --quiet hyperqueue snakemake pandas pyarrow
fi

cleanup() {
    for pid in "$work"/slurmd.pid "$work"/slurmctld.pid "$work"/munged.pid; do
        [ ! -e "$pid" ] || kill "$(cat "$pid")" 2>/dev/null || true
    done
    [ -z "${hq_server:-}" ] || kill $hq_server $hq_worker 2>/dev/null || true
}
trap cleanup EXIT

# A case that takes a tenth of a second, over two values of friction with one that always fails:
# failures are results too.
cp "$here"/heap.ron "$here"/heap_study.ron "$work/"
study="$work/heap_study.ron"
export_to() {
    "$program" study export "$study" --out "$work/$1" --to "$1" --chunk 3 | tail -n 1
}

echo "== here"
"$program" study run "$study" --out "$work/here" --jobs 2

echo "== jobs"
export_to jobs >/dev/null
xargs -P 2 -d '\n' -n 1 sh -c <"$work/jobs/jobs.txt"
"$program" study collect "$study" --out "$work/jobs"

echo "== snakemake"
export_to snakemake >/dev/null
"$(dirname "$python")/snakemake" --cores 2 --quiet all --keep-going --snakefile "$work/snakemake/Snakefile" --directory "$work/snakemake"

echo "== hyperqueue"
export_to hq >/dev/null
if command -v hq >/dev/null; then
    export HQ_SERVER_DIR="$work/hq-server"
    hq server start >"$work/hq-server.log" 2>&1 &
    hq_server=$!
    sleep 1
    hq worker start --cpus 2 >"$work/hq-worker.log" 2>&1 &
    hq_worker=$!
    hq job submit-file "$work/hq/study.hq.toml"
    hq job wait last
else
    "$python" "$here/hyperqueue_tasks.py" "$work/hq/study.hq.toml"
fi
"$program" study collect "$study" --out "$work/hq"

echo "== slurm"
host=$(hostname -s)
mkdir -p "$work/state" "$work/spool"
dd if=/dev/urandom of="$work/munge.key" bs=1024 count=1 status=none
chmod 400 "$work/munge.key"
# munge wants folders that others may not write to, and a socket in a short path.
socket=$(mktemp -d)/munge.socket
chmod 755 "$(dirname "$socket")"
munged --key-file="$work/munge.key" --socket="$socket" --pid-file="$work/munged.pid" --log-file="$work/munged.log" \
    --seed-file="$work/munged.seed" --force
cat >"$work/slurm.conf" <<CONF
ClusterName=engines
SlurmctldHost=$host(127.0.0.1)
AuthType=auth/munge
AuthInfo=socket=$socket
CredType=cred/munge
SlurmUser=$(id -un)
SlurmdUser=$(id -un)
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,batch_sched_delay=0
ReturnToService=2
MpiDefault=none
SlurmctldPort=16817
SlurmdPort=16818
NodeName=$host NodeAddr=127.0.0.1 CPUs=$(nproc) State=UNKNOWN
PartitionName=all Nodes=ALL Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF="$work/slurm.conf"
slurmctld
slurmd
for _ in $(seq 60); do
    sinfo -h -o %T 2>/dev/null | grep -q idle && break
    sleep 1
done
export_to slurm >/dev/null
sh "$work/slurm/submit.sh"
for _ in $(seq 180); do
    [ -n "$(squeue -h)" ] || break
    sleep 1
done
[ -z "$(squeue -h)" ] || { squeue; echo "Slurm did not end its jobs" >&2; exit 1; }

echo "== compare"
"$python" "$here/same_tables.py" "$work" here jobs snakemake hq slurm
