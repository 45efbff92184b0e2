#include "catena/columns/column_set.hpp"

#include <algorithm>
#include <array>
#include <functional>
#include <optional>
#include <unordered_set>

#include "catena/columns/energy.hpp"

namespace catena {
namespace {

/// Why a column can be missing.
enum Lack { no_velocity, no_acceleration, no_multipliers, no_work, no_mass, eliminated, lacks };

Needs needs_of(ColumnKind kind) {
  return {.velocity = has_need(kind, ColumnNeed::velocities),
          .acceleration = has_need(kind, ColumnNeed::accelerations),
          .multipliers = has_need(kind, ColumnNeed::multipliers),
          .work = has_need(kind, ColumnNeed::sums)};
}

/// Whether an elastic rope has friction on pulleys: its tension at an end is found with the accelerations.
bool rubs(const Model& model, int element) {
  return std::any_of(model.rope_paths.begin(), model.rope_paths.end(), [&](const RopePath& path) {
    const auto has_mu = [](const RopeNode& node) { return node.mu > 0; };
    return path.element == element && std::any_of(path.nodes.begin(), path.nodes.end(), has_mu);
  });
}

bool needs_mass(ColumnKind kind, const Model& model) {
  return has_need(kind, ColumnNeed::masses) || (has_need(kind, ColumnNeed::weight) && model.gravity != Vec2<double>{});
}

/// Columns that were left out for one reason: the first one's name, and how many.
struct LeftOut {
  std::string first;
  int count = 0;
};

std::string describe(Lack lack, const LeftOut& columns, const ColumnSources& sources, std::string_view body) {
  std::string text = "left out " + columns.first;
  if (columns.count > 1) text += " and " + std::to_string(columns.count - 1) + " more";
  const std::string analysis = sources.analysis.empty() ? "the analysis" : std::string(sources.analysis);
  switch (lack) {
    case no_velocity:
      return text + ": " + analysis + " gives no velocities";
    case no_acceleration:
      return text + ": " + analysis + " gives no accelerations";
    case no_multipliers:
      return text + ": " + analysis + " gives no reactions and loads";
    case no_work:
      return text + ": " + analysis + " does not sum up work";
    case no_mass:
      return text + ": mass or inertia of body \"" + std::string(body) + "\" is not given";
    default:
      return text + ": the joint is not solved for, since its bodies cannot move";
  }
}

class Resolver {
 public:
  Resolver(const Model& model, const Plan& plan, const ColumnSources& sources)
      : model_(model), plan_(plan), sources_(sources), without_mass_(body_without_mass(model, plan)) {}

  /// Looks up what an own column is made of; throws for what cannot be.
  void read(const Column& column) {
    if (column.kind != ColumnKind::own) return;
    const auto own = static_cast<std::size_t>(column.index), count = model_.own_columns.size();
    if (own >= count) {
      own_inputs_[own] = model_.laws[own - count].inputs;
      return;
    }
    if (auto unknown = find_own_inputs(model_, column.index, own_inputs_)) throw ColumnError(std::move(*unknown));
  }
  const OwnInputs& own_inputs() const { return own_inputs_; }

  std::optional<Lack> lack_of(const Column& column) const {
    std::optional<Lack> lack;
    visit_read_columns(own_inputs_, column, [&](const Column& read) {
      if (!lack) lack = lack_of_read(read);
    });
    return lack;
  }
  std::optional<Lack> lack_of_read(const Column& column) const {
    const Needs wanted = needs_of(column.kind);
    if (wanted.acceleration && !sources_.acceleration) return no_acceleration;
    if (wanted.velocity && !sources_.velocity) return no_velocity;
    if (wanted.multipliers && !sources_.multipliers) return no_multipliers;
    if (wanted.work && !sources_.work) return no_work;
    if (needs_mass(column.kind, model_) && without_mass_ >= 0) return no_mass;
    const bool has_rows = column.kind != ColumnKind::far_pull ||
                          model_.elements[static_cast<std::size_t>(column.index)].kind != ElementKind::force;
    if (is_reaction(column.kind) && has_rows && plan_.element_row[static_cast<std::size_t>(column.index)] < 0 &&
        !plan_.is_released(column.index)) {
      return eliminated;
    }
    return {};
  }

  /// Whether the analysis gives the column; if not, it is counted for the notes.
  bool gives(const NamedColumn& named) {
    const std::optional<Lack> lack = lack_of(named.column);
    if (lack && left_out_[*lack].count++ == 0) left_out_[*lack].first = named.info.name;
    return !lack;
  }

  Column in_plan(Column column) const {
    if (is_body_column(column.kind))
      column.index = column.index < 0 ? plan_.bodies : plan_.plan_body[static_cast<std::size_t>(column.index)];
    return column;
  }

  OwnInputs own_inputs_in_plan() const {
    OwnInputs inputs = own_inputs_;
    for (std::vector<Column>& columns : inputs) {
      for (Column& column : columns) column = in_plan(column);
    }
    return inputs;
  }

  std::vector<std::string> notes() const {
    std::vector<std::string> notes;
    for (int lack = 0; lack < lacks; ++lack) {
      const LeftOut& columns = left_out_[static_cast<std::size_t>(lack)];
      const std::string_view body = without_mass_ < 0 ? std::string_view() : model_.body_name(without_mass_);
      if (columns.count > 0) notes.push_back(describe(static_cast<Lack>(lack), columns, sources_, body));
    }
    return notes;
  }

 private:
  const Model& model_;
  const Plan& plan_;
  const ColumnSources& sources_;
  int without_mass_;
  OwnInputs own_inputs_ = OwnInputs(model_.own_columns.size() + model_.laws.size());
  std::array<LeftOut, lacks> left_out_;
};

std::uint64_t key(const Column& column) {
  return static_cast<std::uint64_t>(column.kind) << 56 | static_cast<std::uint64_t>(column.index + 1) << 28 |
         static_cast<std::uint64_t>(column.detail + 1);
}

std::vector<NamedColumn> named_columns(const Model& model, std::span<const std::string> names, bool timed) {
  std::vector<NamedColumn> named;
  if (timed) find_columns(model, "t", named);
  if (names.empty()) {
    for (NamedColumn& column : default_columns(model)) named.push_back(std::move(column));
    return named;
  }
  for (const std::string& name : names) {
    if (auto unknown = find_columns(model, name, named)) throw ColumnError(std::move(*unknown));
  }
  std::unordered_set<std::uint64_t> seen;
  std::erase_if(named, [&](const NamedColumn& column) { return !seen.insert(key(column.column)).second; });
  return named;
}

}  // namespace

ColumnSet ColumnSet::resolve(const Model& model, const Plan& plan, std::span<const std::string> names,
                             const ColumnSources& sources) {
  if (plan.plan_body.size() != model.bodies.size() || plan.element_row.size() != model.elements.size())
    throw std::invalid_argument("columns: the plan is that of another model");
  ColumnSet set;
  set.coordinates_ = static_cast<std::size_t>(plan.coordinates());
  set.only_angles_ = plan.rows > 0 && std::all_of(plan.row_is_angle.begin(), plan.row_is_angle.end(), std::identity());
  Resolver resolver(model, plan, sources);
  std::vector<NamedColumn> named = named_columns(model, names, sources.timed);
  set.info_.reserve(named.size());
  set.columns_.reserve(named.size());
  for (NamedColumn& column : named) {
    resolver.read(column.column);
    if (!resolver.gives(column)) continue;
    visit_read_columns(resolver.own_inputs(), column.column, [&](const Column& read) {
      set.needs_ |= needs_of(read.kind);
      set.needs_.velocity |= sources.velocity && has_need(read.kind, ColumnNeed::damping);
      set.needs_.multipliers |= sources.multipliers && read.kind == ColumnKind::tension && rubs(model, read.index);
    });
    set.columns_.push_back(resolver.in_plan(column.column));
    if (set.only_angles_ && column.column.kind == ColumnKind::residual) column.info.unit = UnitKind::angle;
    set.info_.push_back(std::move(column.info));
  }
  set.own_inputs_ = resolver.own_inputs_in_plan();
  set.notes_ = resolver.notes();
  return set;
}

}  // namespace catena
