#include "documents/document.hpp"

#include <cmath>
#include <ctime>

#include "catena/scene/json/json_document.hpp"
#include "catena/scene/json/json_text.hpp"

namespace bench {

using namespace catena;

namespace {

std::string now() {
  const std::time_t time = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&time, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

/// Members of one object, written in turn.
class JsonObject {
 public:
  explicit JsonObject(std::string& out) : out_(out) { out_ += '{'; }
  void end() { out_ += '}'; }
  std::string& key(std::string_view name) {
    if (!first_) out_ += ", ";
    first_ = false;
    append_json(out_, name);
    out_ += ": ";
    return out_;
  }
  void text(std::string_view name, std::string_view value) { append_json(key(name), value); }
  void number(std::string_view name, double value) { append_json(key(name), value); }
  void whole(std::string_view name, std::int64_t value) { append_json(key(name), value); }
  void flag(std::string_view name, bool value) { append_json(key(name), value); }

 private:
  std::string& out_;
  bool first_ = true;
};

void append_row(std::string& out, const Row& row) {
  JsonObject o(out);
  o.text("suite", row.suite);
  o.text("problem", row.problem);
  o.text("engine", row.engine);
  o.text("method", row.method);
  o.text("setting", row.setting);
  o.whole("bodies", row.bodies);
  o.number("seconds", row.seconds);
  o.number("spread", row.spread);
  o.whole("repeats", row.repeats);
  o.number("error", row.error);
  o.number("allowed", row.allowed);
  o.text("error_of", row.error_of);
  o.text("reference", row.reference);
  o.number("bytes_per_body", row.bytes_per_body);
  JsonObject counts(o.key("counts"));
  for (const auto& [name, value] : row.counts) counts.number(name, value);
  counts.end();
  o.text("failure", row.failure);
  o.end();
}

/// Reads members by name; what is missing or of another kind is an error that names it.
class Reader {
 public:
  Reader(const JsonValue& object, const std::string& file, std::string where)
      : object_(object), file_(file), where_(std::move(where)) {
    if (!object.is(JsonKind::object)) fail("is not an object");
  }
  JsonValue member(std::string_view name, JsonKind kind) const {
    const JsonValue value = object_.find(name);
    if (!value || !value.is(kind)) fail("has no \"" + std::string(name) + "\" that is " + std::string(describe(kind)));
    return value;
  }
  std::string text(std::string_view name) const { return std::string(member(name, JsonKind::string).text()); }
  int whole(std::string_view name) const { return static_cast<int>(member(name, JsonKind::number).number()); }
  bool flag(std::string_view name) const { return member(name, JsonKind::boolean).boolean(); }
  /// null: not measured.
  double number(std::string_view name) const {
    const JsonValue value = object_.find(name);
    if (value && value.is(JsonKind::null)) return not_measured;
    return member(name, JsonKind::number).number();
  }
  [[noreturn]] void fail(const std::string& what) const { throw DocumentError(file_ + ": " + where_ + " " + what); }

 private:
  JsonValue object_;
  const std::string& file_;
  std::string where_;
};

Row read_row(const JsonValue& value, const std::string& file, std::size_t number) {
  const Reader r(value, file, "row " + std::to_string(number));
  Row row{
      .suite = r.text("suite"), .problem = r.text("problem"), .engine = r.text("engine"), .method = r.text("method")};
  row.setting = r.text("setting");
  row.bodies = r.whole("bodies");
  row.seconds = r.number("seconds");
  row.spread = r.number("spread");
  row.repeats = r.whole("repeats");
  row.error = r.number("error");
  row.allowed = r.number("allowed");
  row.error_of = r.text("error_of");
  row.reference = r.text("reference");
  row.bytes_per_body = r.number("bytes_per_body");
  row.failure = r.text("failure");
  for (const JsonMember& count : r.member("counts", JsonKind::object).members()) {
    if (count.value.is(JsonKind::number)) row.counts.emplace_back(count.name(), count.value.number());
  }
  return row;
}

}  // namespace

Document make_document(std::vector<Row> rows, std::vector<std::string> notes, bool brief) {
  Document document;
  document.catena = CATENA_VERSION;
  document.date = now();
  document.brief = brief;
  document.machine = this_machine();
  document.notes = std::move(notes);
  document.rows = std::move(rows);
  return document;
}

std::string to_json(const Document& document) {
  std::string out;
  JsonObject o(out);
  o.whole("catena_bench", Document::version);
  o.text("catena", document.catena);
  o.text("date", document.date);
  o.flag("brief", document.brief);
  JsonObject machine(o.key("machine"));
  machine.text("cpu", document.machine.cpu);
  machine.whole("cores", document.machine.cores);
  machine.number("memory", document.machine.memory);
  machine.text("system", document.machine.system);
  machine.text("compiler", document.machine.compiler);
  machine.number("load", document.machine.load);
  machine.end();
  o.key("notes") += '[';
  for (std::size_t k = 0; k < document.notes.size(); ++k) {
    if (k > 0) out += ", ";
    append_json(out, document.notes[k]);
  }
  out += ']';
  o.key("growth") += '[';
  bool first = true;
  for (const Growth& growth : growth_of(document.rows)) {
    out += first ? "\n" : ",\n";
    first = false;
    JsonObject g(out);
    g.text("problem", growth.problem);
    g.text("method", growth.method);
    g.number("exponent", growth.exponent);
    g.whole("points", growth.points);
    g.end();
  }
  out += ']';
  o.key("rows") += '[';
  for (std::size_t k = 0; k < document.rows.size(); ++k) {
    out += k == 0 ? "\n" : ",\n";
    append_row(out, document.rows[k]);
  }
  out += "\n]";
  o.end();
  return out + "\n";
}

Document read_document(const std::string& path) {
  const SourceText source = SourceText::read(path);
  Diagnostics diagnostics;
  const auto parsed = JsonDocument::parse(source, diagnostics);
  if (!parsed || !diagnostics.ok()) throw DocumentError(diagnostics.text());
  const std::string where = "the document";
  const Reader r(parsed->root(), path, where);
  const JsonValue version = parsed->root().find("catena_bench");
  if (!version || !version.is(JsonKind::number)) r.fail("was not written by catena bench: it has no \"catena_bench\"");
  if (version.number() != Document::version)
    r.fail("has version " + std::to_string(static_cast<int>(version.number())) + " of the format, this program reads " +
           std::to_string(Document::version) + ": run the suites again");
  Document document;
  document.catena = r.text("catena");
  document.date = r.text("date");
  document.brief = r.flag("brief");
  const Reader m(r.member("machine", JsonKind::object), path, "\"machine\"");
  document.machine = {m.text("cpu"),    m.text("system"), m.text("compiler"),
                      m.whole("cores"), m.number("load"), m.number("memory")};
  for (const JsonValue& note : r.member("notes", JsonKind::array).elements()) {
    if (note.is(JsonKind::string)) document.notes.emplace_back(note.text());
  }
  for (const JsonValue& row : r.member("rows", JsonKind::array).elements())
    document.rows.push_back(read_row(row, path, document.rows.size() + 1));
  return document;
}

std::vector<Growth> growth_of(const std::vector<Row>& rows) {
  struct Sums {
    Growth growth;
    double x = 0, y = 0, xx = 0, xy = 0;
  };
  std::vector<Sums> all;
  for (const Row& row : rows) {
    if (row.suite != "scaling" || row.engine != "catena" || row.bodies < 100 || !(row.seconds > 0)) continue;
    std::size_t k = 0;
    while (k < all.size() && (all[k].growth.problem != row.problem || all[k].growth.method != row.method)) ++k;
    if (k == all.size()) all.push_back({.growth = {.problem = row.problem, .method = row.method}});
    const double x = std::log(row.bodies), y = std::log(row.seconds);
    Sums& s = all[k];
    s.x += x, s.y += y, s.xx += x * x, s.xy += x * y;
    ++s.growth.points;
  }
  std::vector<Growth> fitted;
  for (Sums& s : all) {
    const double n = s.growth.points, spread = n * s.xx - s.x * s.x;
    if (s.growth.points < 2 || !(spread > 0)) continue;
    s.growth.exponent = (n * s.xy - s.x * s.y) / spread;
    fitted.push_back(s.growth);
  }
  return fitted;
}

}  // namespace bench
