# Sourced by the scripts of tasks.

# Runs a command until it ends, or until Slurm says that the time is nearly up (SIGTERM). A command that was stopped, which
# is exit code 75, is queued again.
stoppable() {
  local code render
  "$@" &
  render=$!
  # Slurm tells the script alone.
  trap 'kill -TERM $render' TERM
  wait $render
  code=$?
  while kill -0 $render 2>/dev/null; do
    wait $render
    code=$?
  done
  if ((code == 75)); then
    scontrol requeue "${SLURM_ARRAY_JOB_ID}_$SLURM_ARRAY_TASK_ID" && sleep 60
  fi
  exit $code
}
