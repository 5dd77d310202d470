# shellcheck shell=bash
# After `source setup.bash`, `flexarm` is the program of this workspace, and its commands and options are completed.
if [ -x "$CATKIN_ENV_HOOK_WORKSPACE/lib/flexarm/flexarm" ]; then
  # Not `flexarm() {`: an alias of that name would stand in the way.
  eval "function flexarm { '$CATKIN_ENV_HOOK_WORKSPACE/lib/flexarm/flexarm' \"\$@\"; }"
  eval "$(flexarm completion bash 2>/dev/null)"
fi
