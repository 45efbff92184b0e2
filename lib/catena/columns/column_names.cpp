#include "catena/columns/column_names.hpp"

#include <algorithm>

#include "catena/columns/element_columns.hpp"
#include "catena/columns/own_columns.hpp"
#include "catena/columns/switches.hpp"

namespace catena {
namespace {

constexpr bool turns(ColumnKind kind) {
  return kind == ColumnKind::angle || kind == ColumnKind::omega || kind == ColumnKind::alpha;
}

std::string join(std::string_view a, std::string_view b) {
  std::string text(a);
  if (!b.empty()) text.append(".").append(b);
  return text;
}

std::string quoted(std::string_view text) { return "\"" + std::string(text) + "\""; }

/// Whether `candidate` may be a misspelling of `name`, judged by the lengths before any distance is computed.
bool similar_length(std::string_view name, std::string_view candidate) {
  const std::size_t slack = 2 + name.size() / 3;
  return candidate.size() <= name.size() + slack && name.size() <= candidate.size() + slack;
}

/// The element at the end j of a rope, of which a pulley that rolls makes several (rope_way.hpp).
int at_end_of_rope(const Model& model, int element) {
  bool leads_here = false;
  for (std::size_t k = 0; k < model.rope_paths.size(); ++k) {
    if (model.rope_paths[k].element != element) {
      leads_here = model.rope_paths[k].leads_on;
      continue;
    }
    if (leads_here) return element;  // a part that was asked for by its own name
    while (model.rope_paths[k].leads_on && k + 1 < model.rope_paths.size()) ++k;
    return model.rope_paths[k].element;
  }
  return element;
}

/// Looks up one name. The parts of a name are views into it.
class Lookup {
 public:
  Lookup(const Model& model, std::string_view name, std::vector<NamedColumn>& out)
      : model_(model), name_(name), out_(out) {
    const std::size_t dot = name.find('.');
    head_ = name.substr(0, dot);
    if (dot != std::string_view::npos) rest_ = name.substr(dot + 1);
    dotted_ = dot != std::string_view::npos;
  }

  std::optional<UnknownColumn> run() {
    if (name_ == "t") return take("t", UnitKind::time, {ColumnKind::time});
    if (const int own = model_.find_own_column(name_); own >= 0) {
      const std::string& unit = model_.own_columns[static_cast<std::size_t>(own)].unit;
      out_.push_back({{std::string(name_), UnitKind::own, unit}, {ColumnKind::own, own}});
      return {};
    }
    // In radians if the plan turns out to have rows of angles alone; see ColumnSet::resolve.
    if (name_ == "residual") return take("residual", UnitKind::length, {ColumnKind::residual});
    if (head_ == "energy") return group(energy_kinds);
    if (head_ == "momentum") return group(momentum_kinds);
    if (const int body = model_.find_body(head_); body >= ground) return body_name(body);
    if (const int element = model_.find_element(head_); element >= 0) return element_name(element);
    if (std::optional<NamedColumn> found = find_switch(model_, name_)) {
      out_.push_back(std::move(*found));
      return {};
    }
    return unknown_head();
  }

 private:
  std::optional<UnknownColumn> take(std::string name, UnitKind unit, Column column) {
    out_.push_back({{std::move(name), unit}, column});
    return {};
  }

  std::optional<UnknownColumn> group(std::span<const NamedKind> table) {
    bool found = false;
    for (const NamedKind& column : table) {
      if (dotted_ && rest_ != column.name) continue;
      take(join(head_, column.name), column.unit, {column.kind});
      found = true;
    }
    if (found) return {};
    UnknownColumn unknown{std::string(name_), "there is no " + quoted(rest_) + " of " + std::string(head_), {}};
    for (const NamedKind& column : table) unknown.candidates.push_back(join(head_, column.name));
    return unknown;
  }

  std::optional<UnknownColumn> body_name(int body) {
    const std::size_t dot = rest_.find('.');
    const std::string_view first = rest_.substr(0, dot);
    const int point = dotted_ ? find_point(body, first) : -1;
    const std::string_view column =
        point < 0 ? rest_ : (dot == std::string_view::npos ? std::string_view() : rest_.substr(dot + 1));
    const bool all = point < 0 ? !dotted_ : dot == std::string_view::npos;
    const std::string_view owner = point < 0 ? head_ : name_.substr(0, head_.size() + 1 + first.size());
    bool found = false;
    for (const NamedKind& simple : body_kinds) {
      if (point >= 0 && turns(simple.kind)) continue;
      if (!all && column != simple.name) continue;
      take(join(owner, simple.name), simple.unit, {simple.kind, body, point});
      found = true;
    }
    if (found) return {};
    return unknown_of_body(body, point, owner, column);
  }

  std::optional<UnknownColumn> unknown_of_body(int body, int point, std::string_view owner, std::string_view column) {
    UnknownColumn unknown{std::string(name_), {}, {}};
    if (point >= 0) {
      unknown.message = "point " + quoted(owner) + " has no column " + quoted(column);
    } else {
      unknown.message = (body < 0 ? "the ground" : "body " + quoted(owner)) + " has no point or column " +
                        quoted(column.substr(0, column.find('.')));
    }
    for (const NamedKind& simple : body_kinds) {
      if (point < 0 || !turns(simple.kind)) unknown.candidates.push_back(join(owner, simple.name));
    }
    if (point >= 0) return unknown;
    // A misspelt point: the same column of every other point of the body.
    const std::size_t dot = column.find('.');
    const std::string_view wanted = dot == std::string_view::npos ? std::string_view() : column.substr(dot + 1);
    for (int p = first_point(body); p >= 0; p = model_.points[static_cast<std::size_t>(p)].next) {
      const std::string_view point_name = model_.point_names[model_.points[static_cast<std::size_t>(p)].name];
      unknown.candidates.push_back(join(join(owner, point_name), wanted));
    }
    return unknown;
  }

  std::optional<UnknownColumn> element_name(int element) {
    const std::vector<ElementColumn> columns = columns_of_element(model_, element);
    bool found = false;
    for (const ElementColumn& column : columns) {
      if (rest_ != column.suffix && !(column.in_reaction && rest_ == "reaction")) continue;
      const int held = column.kind == ColumnKind::far_pull ? at_end_of_rope(model_, element) : element;
      take(join(head_, column.suffix), column.unit, {column.kind, held, column.detail});
      found = true;
    }
    if (found) return {};
    UnknownColumn unknown{std::string(name_), std::string(model_.element_type(element)) + " " + quoted(head_), {}};
    unknown.message += dotted_ ? " has no column " + quoted(rest_) : " is no column by itself: name one of its columns";
    std::string list;
    for (const ElementColumn& column : columns) {
      unknown.candidates.push_back(join(head_, column.suffix));
      list += (list.empty() ? "" : ", ") + column.suffix;
    }
    unknown.candidates.push_back(join(head_, "reaction"));
    if (!columns.empty()) unknown.message += " (it has " + list + ")";
    return unknown;
  }

  std::optional<UnknownColumn> unknown_head() {
    UnknownColumn unknown{std::string(name_), {}, {}};
    unknown.message = "there is no body, constraint, driver or force " + quoted(head_);
    const auto consider = [&](std::string_view known) {
      if (similar_length(head_, known)) unknown.candidates.push_back(join(known, rest_));
    };
    for (const std::string_view known : {"t", "residual", "energy", "momentum", "ground"}) consider(known);
    for (int k = 0; k < model_.names.size(); ++k) consider(model_.names[k]);
    for (const OwnColumn<double>& column : model_.own_columns) consider(column.name);
    return unknown;
  }

  int first_point(int body) const {
    return body < 0 ? model_.first_ground_point : model_.bodies[static_cast<std::size_t>(body)].first_point;
  }
  int find_point(int body, std::string_view name) const {
    const int number = model_.point_names.find(name);
    if (number < 0) return -1;
    int p = first_point(body);
    while (p >= 0 && model_.points[static_cast<std::size_t>(p)].name != number)
      p = model_.points[static_cast<std::size_t>(p)].next;
    return p;
  }

  const Model& model_;
  std::string_view name_, head_, rest_;  // head_.rest_
  bool dotted_ = false;
  std::vector<NamedColumn>& out_;
};

}  // namespace

std::optional<UnknownColumn> find_columns(const Model& model, std::string_view name, std::vector<NamedColumn>& out) {
  return Lookup(model, name, out).run();
}

std::vector<UnknownColumn> unknown_columns(const Model& model, std::span<const std::string> names) {
  std::vector<UnknownColumn> unknown;
  std::vector<NamedColumn> found;
  for (const std::string& name : names) {
    found.clear();
    if (auto reason = find_columns(model, name, found)) unknown.push_back(std::move(*reason));
  }
  return unknown;
}

std::vector<int> elements_with_reactions(const Model& model, std::span<const std::string> names) {
  std::vector<int> elements;
  std::vector<NamedColumn> found;
  OwnInputs inputs(model.own_columns.size());
  for (const std::string& name : names) {
    found.clear();
    find_columns(model, name, found);
    for (const NamedColumn& named : found) {
      if (named.column.kind == ColumnKind::own && find_own_inputs(model, named.column.index, inputs)) continue;
      visit_read_columns(inputs, named.column, [&](const Column& column) {
        if (is_reaction(column.kind)) elements.push_back(column.index);
      });
    }
  }
  std::sort(elements.begin(), elements.end());
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  return elements;
}

std::vector<NamedColumn> default_columns(const Model& model) {
  std::vector<NamedColumn> columns;
  columns.reserve(3 * model.bodies.size());
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    for (std::size_t k = 0; k < 3; ++k) {
      const NamedKind& simple = body_kinds[k];
      columns.push_back({{join(model.body_name(body), simple.name), simple.unit}, {simple.kind, body, -1}});
    }
  }
  return columns;
}

}  // namespace catena
