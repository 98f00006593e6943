#!/usr/bin/env bash
# slurm.sh up FOLDER [CORES]: a Slurm of one machine, on 127.0.0.1, without systemd, as root or as
# any user. slurm.sh down FOLDER ends it. Its SLURM_CONF is FOLDER/slurm.conf.
set -euo pipefail
folder=$(realpath -m "$2")

up() {
  local cores=$1 me
  me=$(id -un)
  mkdir -p "$folder"/{munge,state,spool}
  chmod 755 "$folder"; chmod 711 "$folder/munge"
  (umask 077; head -c 128 /dev/urandom > "$folder/munge/key")
  munged --force --key-file="$folder/munge/key" --socket="$folder/munge/socket" \
    --pid-file="$folder/munge/pid" --log-file="$folder/munge/log" --seed-file="$folder/munge/seed"
  configure "$cores" "$me" > "$folder/slurm.conf"
  # Without the file, 22.05 does not start where there is cgroup v2 alone; "disabled" came later.
  case $(slurmd -V) in
    *\ 2[012].*) echo CgroupPlugin=cgroup/v1 ;;
    *) echo CgroupPlugin=disabled ;;
  esac > "$folder/cgroup.conf"
  export SLURM_CONF=$folder/slurm.conf
  slurmctld
  slurmd -N localhost
  local i
  for i in $(seq 300); do
    [ "$(sinfo -h -o %T 2>/dev/null)" = idle ] && return
    sleep 0.1
  done
  echo "slurm.sh: the node is not idle after 30 s" >&2
  tail -n 5 "$folder"/*.log >&2
  return 1
}

configure() {
  cat <<CONF
ClusterName=local
SlurmctldHost=localhost(127.0.0.1)
SlurmctldPort=16817
SlurmdPort=16818
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
SlurmUser=$2
SlurmdUser=$2
AuthType=auth/munge
AuthInfo=socket=$folder/munge/socket
StateSaveLocation=$folder/state
SlurmdSpoolDir=$folder/spool
SlurmctldPidFile=$folder/slurmctld.pid
SlurmdPidFile=$folder/slurmd.pid
SlurmctldLogFile=$folder/slurmctld.log
SlurmdLogFile=$folder/slurmd.log
ProctrackType=proctrack/pgid
TaskPlugin=task/affinity
JobCompType=jobcomp/filetxt
JobCompLoc=$folder/jobs.txt
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
SchedulerParameters=batch_sched_delay=0,sched_interval=1,bf_interval=1
ReturnToService=2
RequeueExit=75
SlurmdParameters=config_overrides
KillWait=5
NodeName=localhost NodeAddr=127.0.0.1 CPUs=$1 State=UNKNOWN
PartitionName=local Nodes=localhost Default=YES MaxTime=INFINITE State=UP
CONF
}

down() {
  local file i
  for file in slurmd.pid slurmctld.pid munge/pid; do
    [ ! -f "$folder/$file" ] || kill "$(cat "$folder/$file")" 2>/dev/null || true
    for i in $(seq 100); do
      [ -f "$folder/$file" ] || break
      sleep 0.1
    done
  done
}

case $1 in
  up) up "${3:-$(nproc)}" ;;
  down) down ;;
  *) echo "slurm.sh: up or down?" >&2; exit 2 ;;
esac
