# shellcheck shell=bash
# After `source setup.zsh`, the Tab key completes commands and options of `flexarm`.
if [ -x "$CATKIN_ENV_HOOK_WORKSPACE/lib/flexarm/flexarm" ]; then
  eval "$("$CATKIN_ENV_HOOK_WORKSPACE/lib/flexarm/flexarm" completion zsh 2>/dev/null)"
fi
