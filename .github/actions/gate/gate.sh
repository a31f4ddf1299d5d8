#!/usr/bin/env bash
# Runs `carom gate` for action.yml, whose settings are in BASE, BUILD, WORDS, OPTIONS and LABEL (of the pull request, empty
# without it), and puts the result into the job's summary. Ends with the gate's own exit code.
set -uo pipefail
report=$RUNNER_TEMP/carom-gate.md
accepted=$RUNNER_TEMP/carom-gate-accepted
rm -f "$report" "$accepted"
[[ -z $LABEL ]] || echo "the pull request has the label $LABEL" >"$accepted"
read -ra options <<<"$OPTIONS"
read -ra words <<<"$WORDS"
PATH=$HOME/.local/bin:$PATH carom gate --base "$BASE" --build "$BUILD" --accept "$accepted" --export-markdown "$report" \
    ${options[@]+"${options[@]}"} -- "${words[@]}"
code=$?
[[ ! -f $report ]] || cat "$report" >>"$GITHUB_STEP_SUMMARY"
echo "report=$report" >>"$GITHUB_OUTPUT"
exit "$code"
