# SPDX-FileCopyrightText: The Swiftlet authors
# SPDX-License-Identifier: Apache-2.0
#
# Completion for bash: `source` this file, or install it where bash-completion looks. It asks the
# program itself, so it knows what that program knows.
_swiftlet() {
  local IFS=$'\n'
  COMPREPLY=($("${COMP_WORDS[0]}" complete -- "${COMP_WORDS[@]:1:COMP_CWORD}" 2>/dev/null))
}
complete -o default -F _swiftlet swiftlet
