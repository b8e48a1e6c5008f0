#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Runs a Slurm cluster of four nodes on this machine, with its own keys, ports and folders, without systemd. Renders two
# frames in shards by `orrery submit --slurm`, kills a node in the middle of its task, and compares the merged images
# with those of a single process.
#
#   tests/batch/slurm.sh PROGRAM WORK_FOLDER
#
# Exit status 77 if Slurm is not installed or the user is not root.
set -eu
[ $# -eq 2 ] || { sed -n '3,9s/^# \{0,1\}//p' "$0"; exit 2; }
scenes=$(cd "$(dirname "$0")/../../scenes" && pwd)
program=$(realpath "$1")
mkdir -p "$2"
folder=$(realpath "$2")
for tool in munged slurmctld slurmd sbatch squeue; do
  command -v "$tool" > /dev/null || { echo "slurm: skipped: $tool is not installed (packages munge, slurm-wlm)"; exit 77; }
done
[ "$(id -u)" -eq 0 ] || { echo "slurm: skipped: only root can start nodes"; exit 77; }

host=$(hostname -s)
rm -rf "$folder/cluster" "$folder/shot.____.exr.shards" "$folder"/*.exr
mkdir -p "$folder/cluster/state" "$folder/cluster/keys"
chmod 0700 "$folder/cluster/keys"
cd "$folder"

stop_all() {
  for pid in cluster/slurmctld.pid cluster/slurmd.n*.pid cluster/keys/munged.pid; do
    [ -f "$pid" ] && kill -9 "$(cat "$pid")" 2> /dev/null || true
  done
  for pid in $(pgrep slurmstepd); do
    if grep -qzx "SLURM_CONF=$folder/cluster/slurm.conf" "/proc/$pid/environ" 2> /dev/null; then kill -9 "$pid"; fi
  done
}
trap stop_all EXIT

dd if=/dev/urandom of=cluster/keys/key bs=128 count=1 2> /dev/null
chmod 0400 cluster/keys/key
munged --force --key-file="$folder/cluster/keys/key" --socket="$folder/cluster/keys/socket" \
  --pid-file="$folder/cluster/keys/munged.pid" --log-file="$folder/cluster/keys/log" --seed-file="$folder/cluster/keys/seed"

# Ports derived from the process id, so that two clusters do not collide, and below those that the system assigns.
port=$((20000 + $$ % 2500 * 5))
# A task of a lost node waits until its credentials have expired, by default after 120 seconds.
cat > cluster/slurm.conf << END
ClusterName=orrery
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
AuthType=auth/munge
CredType=cred/munge
AuthInfo=socket=$folder/cluster/keys/socket,cred_expire=20
SlurmctldPort=$port
SlurmctldPidFile=$folder/cluster/slurmctld.pid
SlurmdPidFile=$folder/cluster/slurmd.%n.pid
SlurmctldLogFile=$folder/cluster/slurmctld.log
SlurmdLogFile=$folder/cluster/slurmd.%n.log
StateSaveLocation=$folder/cluster/state
SlurmdSpoolDir=$folder/cluster/spool.%n
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
MpiDefault=none
CommunicationParameters=NoCtldInAddrAny,NoInAddrAny
SlurmdTimeout=10
SlurmctldTimeout=30
KillWait=5
ReturnToService=2
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SlurmdParameters=config_overrides
SchedulerParameters=sched_interval=2,bf_interval=2
NodeName=n0 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 1)) CPUs=1
NodeName=n1 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 2)) CPUs=1
NodeName=n2 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 3)) CPUs=1
NodeName=n3 NodeHostname=$host NodeAddr=127.0.0.1 Port=$((port + 4)) CPUs=1
PartitionName=all Nodes=ALL Default=YES State=UP
END
export SLURM_CONF="$folder/cluster/slurm.conf"
slurmctld
for node in n0 n1 n2 n3; do slurmd -N "$node"; done

wait_for() {  # seconds, what, command ...
  # By the clock: without its controller, a command of Slurm fails only after 9 seconds.
  end=$(($(date +%s) + $1))
  what=$2
  shift 2
  until "$@"; do
    if [ "$(date +%s)" -gt "$end" ]; then
      echo "slurm: timed out waiting for $what"
      tail -5 cluster/*.log
      sinfo -lN
      squeue
      exit 1
    fi
    sleep 1
  done
}
four_are_idle() { [ "$(sinfo --noheader --states=idle -o %D)" = 4 ]; }
wait_for 120 "four nodes" four_are_idle

settings="--width 320 --height 180 --samples ${SAMPLES:-30} --set animation.turntable=48 --layers Z,CryptoObject --reproducible"
cp "$scenes/book/final.toml" shot.toml
# The first task on n1 never finishes, so the node is killed in the middle of a task on any machine.
cat > first-hangs-on-n1 << END
#!/bin/sh
if [ "\$SLURMD_NODENAME" = n1 ] && mkdir "$folder/cluster/hangs" 2> /dev/null; then
  echo \$\$ > "$folder/cluster/hangs/pid.new"
  mv "$folder/cluster/hangs/pid.new" "$folder/cluster/hangs/pid"
  exec sleep infinity
fi
exec "$program" "\$@"
END
chmod +x first-hangs-on-n1
# shellcheck disable=SC2086  # words
"$program" submit shot.toml -o shot.####.exr --frames 1-2 --shards 4 $settings --slurm \
  --program "$folder/first-hangs-on-n1" > shot.sh
sh shot.sh
wait_for 600 "a task on n1" test -f cluster/hangs/pid
killed=$(squeue --noheader --states=running --nodelist=n1 -o %i)
echo "slurm: killing node n1 with its task $killed"
kill -9 "$(cat cluster/slurmd.n1.pid)"
rm -f cluster/slurmd.n1.pid
# Kill the task's slurmstepd first, so that it cannot report the end of the task; then the job script and the task.
pid=$(cat cluster/hangs/pid)
chain=$pid
while [ "$(cat "/proc/$pid/comm")" != slurmstepd ] && [ "$pid" -gt 1 ]; do
  pid=$(sed -n 's/^PPid:[[:space:]]*//p' "/proc/$pid/status")
  chain="$pid $chain"
done
[ "$pid" -gt 1 ] || { echo "slurm: the task on n1 has no slurmstepd ancestor"; exit 1; }
# shellcheck disable=SC2086  # words
kill -9 $chain

all_done() { [ "$(squeue --noheader -o %i | wc -l)" -eq 0 ]; }
wait_for 600 "the end of all jobs" all_done
starts=$(grep -c "\(Started\|Allocate\) JobId=$killed(" cluster/slurmctld.log)
[ "$starts" -ge 2 ] || { echo "slurm: the killed task $killed was started $starts times"; exit 1; }

for frame in 1 2; do
  # shellcheck disable=SC2086
  "$program" render shot.toml -o "one.####.exr" --frames $frame $settings -q
  cmp "one.000$frame.exr" "shot.000$frame.exr" || { tail -n 3 shot.____.exr.shards/*.log; exit 1; }
done
echo "slurm: two frames in four shards each, one node killed: the same bytes as a single process"
