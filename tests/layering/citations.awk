# What sources and pages cite must be in the repository; run by check.sh. Prints violations and exits 1 if there are any.
#
#   awk -f citations.awk PAGE... cited=1 PAGE... SOURCE...
#
# The first pass over the pages (README.md, apps/manual/*.md) collects their headings, as the anchors that links name:
# small letters, blanks as hyphens, punctuation dropped. After `cited=1` every `page.md` or `page.md#anchor` must be one
# of them: in pages relative to the page's own folder, in sources from the top of the tree.

function report(message) {
  printf "%s:%d: %s\n", FILENAME, FNR, message
  bad = 1
}

function anchor_of(heading) {
  sub(/^#+ +/, "", heading)
  heading = tolower(heading)
  gsub(/[^a-z0-9 _-]/, "", heading)
  gsub(/ /, "-", heading)
  return heading
}

function check_page(citation,    path, anchor, folder, mark) {
  mark = index(citation, "#")
  path = mark ? substr(citation, 1, mark - 1) : citation
  anchor = mark ? substr(citation, mark + 1) : ""
  if (FILENAME ~ /\.md$/) {
    folder = FILENAME
    if (!sub(/[^\/]*$/, "", folder)) folder = ""
    path = folder path
  } else {
    sub(/^(.*\.\.)?\//, "", path)  # what follows a folder that the source computes
  }
  if (!(path in page))
    report("cites " citation ", which is not in the repository")
  else if (anchor != "" && !((path "#" anchor) in page))
    report("cites " citation ", but " path " has no such heading")
}

!cited {
  page[FILENAME] = 1
  if (/^```/) fenced[FILENAME] = !fenced[FILENAME]
  if (/^#+ / && !fenced[FILENAME]) page[FILENAME "#" anchor_of($0)] = 1
  next
}

{
  line = $0
  while (match(line, /[A-Za-z0-9_.\/-]+\.md(#[A-Za-z0-9_-]+)?/)) {
    check_page(substr(line, RSTART, RLENGTH))
    line = substr(line, RSTART + RLENGTH)
  }
}

# Documents by their names alone: a reader of the sources does not have them.
FILENAME !~ /\.md$/ && match($0, /(^|[^A-Za-z0-9_])(THEORY|NUMERICS|SCENES|DESIGN|HOUSE)([^A-Za-z0-9_]|$)/) {
  name = substr($0, RSTART, RLENGTH)
  gsub(/[^A-Z]/, "", name)
  if ($0 !~ (name "\\.md")) report("cites " name ", which is not in the repository")
}

END { exit bad }
