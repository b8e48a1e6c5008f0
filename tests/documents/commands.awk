# SPDX-License-Identifier: Apache-2.0
# Prints the commands of a Markdown page, each as LINE, a tab, and the command with its line breaks as \001.
#
# A command is a line of a code block that begins with one of the words below; a block with the language `sh` is one
# command. `$ ` before it is dropped, and with it the other lines of the block, which show its output.
function is_command(line) {
  sub(/^([A-Z_]+=[^ ]* )+/, "", line)
  return line ~ /^(orrery|\.\/(run|test)\.sh|time|oiiotool|iinfo|printf|awk|cmake|ctest|ninja|apt(-get)?|perf|jq|ssh|lmp|git|cd|pip|python3|mkdocs|tar|docker|apptainer)( |$)/ ||
    line ~ /^(bench|tools|tests|build|build-ci|examples|venv|orrery-[^ \/]*)\/[^ ]+( |$)/
}
function flush() {
  if (text != "") print start "\t" text
  text = ""
}
function add(line) {
  if (text == "") start = FNR
  text = text (text == "" ? "" : "\001") line
}
/^```/ {
  if (in_fence) flush()
  in_fence = !in_fence
  is_script = in_fence && $0 ~ /^```sh/
  shows_output = 0
  next
}
!in_fence && !/^    / { flush(); shows_output = 0; next }
{
  line = $0
  if (!in_fence) sub(/^    /, "", line)
  if (is_script) { add(line); next }
  if (text != "") { add(line); if (line !~ /\\$/) flush(); next }
  if (sub(/^\$ /, "", line)) shows_output = 1
  else if (shows_output || !is_command(line)) next
  add(line)
  if (line !~ /\\$/) flush()
}
END { flush() }
