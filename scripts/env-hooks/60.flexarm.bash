# shellcheck shell=bash
# After `source setup.bash`, the Tab key completes commands and options of `flexarm`.
if [ -x "$CATKIN_ENV_HOOK_WORKSPACE/lib/flexarm/flexarm" ]; then
  eval "$("$CATKIN_ENV_HOOK_WORKSPACE/lib/flexarm/flexarm" completion bash 2>/dev/null)"
fi
