# The rules on includes and headers; run over all sources by check.sh. Prints violations and exits 1 if there are any.
#
#   base <- elements <- model <- drawing;  base <- linalg
#   {model, linalg} <- assembly <- columns <- analysis <- results;  {results, drawing} <- scene
#
# `may[layer]` lists what a layer may include, itself among it. apps and tests may include every layer, and so may the
# umbrella header lib/catena/catena.hpp. `part[folder]` lists what a folder inside of a layer may include of its own
# layer; a folder that is not listed there is an error, and so is one of more than 30 files:
#
#   analysis  run <- pose <- motion <- {events, branches} <- {kinematics, contact <- {dynamics, contact/holding}};  pose <- balance <- spectrum <- statics/solvers <- statics <- stability
#             run <- measures;  {pose, motion, contact} <- sensitivity, sensitivity/phases, sensitivity/spectrum;  {sensitivity/phases, measures} <- adjoint;  run <- minimiser <- {statics, design};  {kinematics, balance, batch/kernels} <- batch
#             {kinematics, stability, dynamics} <- accuracy
#             run, pose <- kinematics/course <- kinematics;  run <- contact/problem <- contact
#   scene     json <- numbers <- describing <- reading <- building <- models <- judging <- running <- writing <- designing <- viewing <- loading
#             <- explaining
#   assembly  structure <- . <- {systems, design}
#   drawing   shapes <- figures
#   results   . <- terminal

BEGIN {
  may["base"] = " base "
  may["elements"] = " base elements "
  may["model"] = " base elements model "
  may["drawing"] = " base elements model drawing "
  may["linalg"] = " base linalg "
  may["assembly"] = " base elements model linalg assembly "
  may["columns"] = may["assembly"] "columns "
  may["analysis"] = may["columns"] "analysis "
  may["results"] = may["analysis"] "results "
  may["scene"] = may["results"] "drawing scene "
  every = may["scene"]

  chain("analysis", "run pose motion events")
  after("analysis", "kinematics/course", "run pose")
  after("analysis", "kinematics", "run pose motion events contact kinematics/course")
  after("analysis", "branches", "run pose motion")
  after("analysis", "dynamics/integrators", "run pose motion branches")
  after("analysis", "dynamics/implicit", "run pose motion branches dynamics/integrators")
  after("analysis", "contact/problem", "run")
  after("analysis", "contact", "run pose motion events contact/problem")
  after("analysis", "contact/holding", "run pose motion contact")
  after("analysis", "dynamics", "run pose motion branches events contact dynamics/integrators dynamics/implicit")
  after("analysis", "balance", "run pose")
  after("analysis", "spectrum", "run pose balance")
  after("analysis", "minimiser", "run")
  after("analysis", "statics/solvers", "run pose balance spectrum minimiser")
  after("analysis", "statics", "run pose balance spectrum minimiser statics/solvers")
  after("analysis", "stability", "run pose motion balance spectrum statics statics/solvers")
  after("analysis", "measures", "run")
  after("analysis", "sensitivity", "run pose motion")
  after("analysis", "sensitivity/spectrum", "run pose motion sensitivity")
  after("analysis", "sensitivity/phases", "run pose motion events contact sensitivity")
  after("analysis", "adjoint", "run measures motion events contact sensitivity sensitivity/phases")
  after("analysis", "design", "run minimiser")
  after("analysis", "batch/kernels", "")
  after("analysis", "batch", "run pose motion events kinematics/course kinematics balance batch/kernels")
  after("analysis", "accuracy", "run pose motion events kinematics/course kinematics balance spectrum statics statics/solvers stability dynamics dynamics/integrators contact")
  chain("scene", "json numbers describing reading building models judging running writing designing viewing explaining loading")
  chain("drawing", "shapes figures")
  chain("linalg", "patterns kernels")
  after("linalg", "factorization", "patterns kernels")
  after("linalg", "block", "patterns kernels")
  after("linalg", "rank", "patterns kernels factorization")
  after("linalg", "pivoting", "rank")
  after("results", "terminal", ".")
  after("assembly", "structure", "")
  part["assembly/."] = " . structure "
  after("assembly", "systems", ".")
  after("assembly", "design", ".")
  after("elements", "constraints", ".")
  after("elements", "forces", ".")
  part["elements/."] = " . constraints forces "
  bad = 0
}

# chain: each folder may include those before it; after: a folder may include those named. "." is the layer's own folder.
function chain(layer, folders,    name, n, i, before) {
  n = split(folders, name, " ")
  before = ""
  for (i = 1; i <= n; i++) {
    after(layer, name[i], before)
    before = before " " name[i]
  }
}
function after(layer, folder, others) { part[layer "/" folder] = " " others " " folder " " }

# The folder of a path within its layer: "catena/analysis/dynamics/integrators/x.hpp" -> "dynamics/integrators".
function folder_of(path) {
  sub(/^(lib\/)?catena\/[^\/]+\//, "", path)
  if (path !~ /\//) return "."
  sub(/\/[^\/]*$/, "", path)
  return path
}

function report(message) {
  printf "%s:%d: %s\n", FILENAME, FNR, message
  bad = 1
}

# Ipopt and NLopt: the first file that includes one may, a second may not.
function only_one_source(library) {
  if (FILENAME !~ /^lib\/catena\/.*\.cpp$/)
    report(library " may be included by one .cpp of the library only")
  else if ((library in owner) && owner[library] != FILENAME)
    report(library " is included by " owner[library] " already, and may be by one .cpp only")
  else
    owner[library] = FILENAME
}

function check_own_include(path,    piece, n) {
  n = split(path, piece, "/")
  if (path == "catena/catena.hpp") {
    if (in_library) report("the library itself includes what it needs, not catena.hpp")
  } else if (n < 3 || !(piece[2] in may)) {
    report("include \"" path "\" is in no known layer")
  } else if (index(allowed, " " piece[2] " ") == 0) {
    report(layer " may not include " piece[2] " (\"" path "\")")
  } else if (in_library && piece[2] == layer && index(folders, " " folder_of(path) " ") == 0) {
    report(layer "/" folder " may not include " layer "/" folder_of(path) " (\"" path "\")")
  }
}

# Tests compare with whatever serves: these rules are for lib and apps.
function check_outside_include(path) {
  if (FILENAME ~ /^tests\//) return
  if (path ~ /^(suitesparse\/)?(cholmod|klu|umfpack|spqr|SuiteSparse|amd|camd|btf|colamd|ccolamd|ldl|cs|RBio)[A-Za-z_0-9]*\.(h|hpp)$/ ||
      path ~ /^Eigen\/(Cholmod|UmfPack|SPQR|KLU)Support$/ || path ~ /^(cblas|lapacke|openblas_config)[a-z_]*\.h$/) {
    if (FILENAME !~ /^lib\/catena\/linalg\/.*\.cpp$/) report("SuiteSparse and BLAS belong in lib/catena/linalg/*.cpp")
  }
  if (path ~ /^nlohmann\// && FILENAME !~ /^lib\/catena\/scene\/.*\.cpp$/) report("JSON belongs in lib/catena/scene/*.cpp")
  if (path ~ /^(coin\/)?Ip[A-Z][A-Za-z]*\.(h|hpp)$/) only_one_source("Ipopt")
  if (path ~ /^nlopt\.(h|hpp)$/) only_one_source("NLopt")
  if (is_header) {
    if (path ~ /^(Eigen|unsupported\/Eigen|Spectra)(\/|$)/) report("no Eigen in headers: a user's -march would change its alignment")
    if (path ~ /^fmt\//) report("no fmt in headers: compile time")
    if (path == "iostream" || path == "regex") report("no <" path "> in headers: compile time")
  }
}

function end_of_header() {
  if (was_header && !has_pragma) {
    printf "%s:1: header without #pragma once\n", last_file
    bad = 1
  }
}

FNR == 1 {
  end_of_header()
  last_file = FILENAME
  is_header = was_header = (FILENAME ~ /\.hpp$/)
  has_pragma = 0
  in_library = (FILENAME ~ /^lib\/catena\/[^\/]+\//)
  allowed = every
  layer = FILENAME
  if (in_library) {
    split(FILENAME, level, "/")
    layer = level[3]
    if (layer in may) {
      allowed = may[layer]
    } else {
      report("lib/catena/" layer " is no known layer")
      allowed = " "
    }
  }
  if (in_library && layer in may) {
    folder = folder_of(FILENAME)
    folders = " . "
    if ((layer "/" folder) in part)
      folders = part[layer "/" folder]
    else if (folder != ".")
      report("lib/catena/" layer "/" folder " is no known folder")
    if (++held[layer "/" folder] == 31) report("more than 30 files in lib/catena/" layer "/" folder)
  }
  if (is_header && $0 !~ /^\/\/ ?[^ ]/) report("a header opens with a // comment that says what it is")
}

/^#pragma once/ { has_pragma = 1 }

/^[ \t]*#[ \t]*include[ \t]*["<]/ {
  path = $0
  sub(/^[ \t]*#[ \t]*include[ \t]*["<]/, "", path)
  sub(/[">].*$/, "", path)
  if (path ~ /^catena\//)
    check_own_include(path)
  else if (in_library && $0 ~ /include[ \t]*"/)
    report("include \"" path "\" should start with catena/, so that its layer shows")
  else
    check_outside_include(path)
}

END {
  end_of_header()
  exit bad
}
