# Named constants with a number of their own, in the sources of the analyses, by class: printed as
#
#   CLASS<tab>FOLDER<tab>FILE:LINE<tab>NAME = VALUE<tab>reason or -
#
#   threshold   a real number that decides something or was tuned
#   bound       an integer: an end of a loop, a largest size, an interval between checks, a capacity
#   exact       follows from mathematics or from the range of numbers alone: pi, coefficients, shifts of bits, what
#               overflows or underflows when squared
#   other       takes its value from other names: no number of its own
#
# A constant has a reason if a comment stands before its declaration, or behind it, or before a declaration that it
# follows without a line between.
function trim(s) { sub(/^[ \t]+/, "", s); sub(/[ \t]+$/, "", s); return s }

# Splits at commas outside of brackets.
function split_list(text, parts,    n, i, depth, c) {
  n = 1; depth = 0; delete parts; parts[1] = ""
  for (i = 1; i <= length(text); ++i) {
    c = substr(text, i, 1)
    if (c ~ /[(\[{]/) ++depth
    if (c ~ /[)\]}]/) --depth
    if (c == "," && depth == 0) { parts[++n] = ""; continue }
    parts[n] = parts[n] c
  }
  return n
}

function class_of(type, value,    plain, size) {
  plain = value
  gsub(/std::numeric_limits<[a-z]+>::[a-z_]+(\(\))?/, "", plain)
  if (value == "-1" || value ~ /numbers::/ || value ~ /::(infinity|quiet_NaN)/) return "exact"
  if (value ~ /^0x/ && value !~ /^0x1p/) return "exact"
  if (plain !~ /(^|[^A-Za-z_0-9:.])[0-9]/) return "other"
  if (value ~ /is_same_v/ || value ~ /[A-Za-z_]+::|static_cast|sizeof/ && value !~ /^[0-9.]+ \* std::numeric_limits/) return "other"
  if (type != "double" && type != "auto" && type != "float") return "bound"
  size = value + 0
  if (value ~ /^[0-9.e+-]+$/ && (size >= 1e19 || (size > 0 && size <= 1e-100))) return "exact"
  return "threshold"
}

function flush_declaration(    text, type, n, k, parts, name, value, folder, place) {
  text = trim(declaration)
  sub(/^.*constexpr[ \t]+/, "", text)
  sub(/;.*$/, "", text)
  type = text
  sub(/[ \t].*$/, "", type)
  if (text !~ /^[A-Za-z_:0-9]+[ \t]+[a-z_A-Z0-9]+[ \t]*=/) return
  sub(/^[^ \t]+[ \t]+/, "", text)
  folder = FILENAME
  sub(/^.*lib\/catena\/analysis\//, "", folder)
  place = folder
  sub(/\/[^\/]*$/, "", folder)
  sub(/\/.*$/, "", folder)
  n = split_list(text, parts)
  for (k = 1; k <= n; ++k) {
    name = parts[k]; sub(/=.*$/, "", name)
    value = parts[k]; sub(/^[^=]*=/, "", value)
    printf "%s\t%s\t%s:%d\t%s = %s\t%s\n", class_of(type, trim(value)), folder, place, started, trim(name), trim(value), reason ? "reason" : "-"
  }
}

FNR == 1 { open = 0; said = 0 }
{
  line = $0
  comment = match(line, /\/\//)
  code = comment ? substr(line, 1, RSTART - 1) : line
  if (!open) {
    if (trim(code) == "") {
      said = comment ? 1 : 0
      next
    }
    if (code !~ /constexpr[ \t]+(double|int|auto|float|unsigned|long|std::size_t|std::int64_t|std::ptrdiff_t)[ \t]/ || code !~ /=/ && code !~ /constexpr [^;(]*$/) {
      said = 0
      next
    }
    open = 1; started = FNR; declaration = ""; reason = said
  }
  if (comment) reason = 1
  declaration = declaration " " code
  if (code ~ /;/) {
    flush_declaration()
    open = 0
    said = reason
  }
}
