#include "catena/model/elastic_gaps.hpp"

#include <algorithm>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/attachment.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

template <class E, class S>
auto& forces_of(BasicModel<S>& model) {
  return std::get<std::vector<ElementEntry<E, S>>>(model.forces);
}
template <class E, class S>
auto& constraints_of(BasicModel<S>& model) {
  return std::get<std::vector<ElementEntry<E, S>>>(model.constraints);
}

/// Puts an element in the place of number `id`.
template <class E, class S>
void replace(BasicModel<S>& model, int id, const E& element, int i, int j) {
  auto& list = constraints_of<E>(model);
  ElementRecord& record = model.elements[at(id)];
  record.kind = OneSided<E> ? ElementKind::gap : ElementKind::constraint;
  record.type = static_cast<short>(detail::constraint_type<S, E>());
  record.index = static_cast<int>(list.size());
  ElementEntry<E, S> entry{element, i, j};
  entry.id = id;
  list.push_back(entry);
}

template <class S>
void replace_cables(BasicModel<S>& model) {
  auto& cables = forces_of<ElasticCable<S>>(model);
  for (const auto& entry : cables) {
    Cable<S> gap;
    gap.s_i = entry.element.s_i;
    gap.s_j = entry.element.s_j;
    gap.length = entry.element.length;
    gap.k = entry.element.k;
    replace(model, entry.id, gap, entry.i, entry.j);
  }
  cables.clear();
}

template <class S>
void replace_ropes(BasicModel<S>& model) {
  auto& pieces = forces_of<ElasticRope<S>>(model);
  int head = -1;
  for (const auto& entry : pieces) {
    const ElasticRope<S>& piece = entry.element;
    if (piece.pieces > 0) {
      head = entry.id;
      Rope<S> gap;
      static_cast<RopeSpan<S>&>(gap) = piece;
      gap.length = piece.length;
      gap.k = piece.k;
      gap.first_part = static_cast<int>(constraints_of<RopePart<S>>(model).size());
      gap.parts = piece.pieces - 1;
      replace(model, head, gap, entry.i, entry.j);
      continue;
    }
    RopePart<S> part;
    static_cast<RopeSpan<S>&>(part) = piece;
    part.bridge = piece.bridge;
    part.head = head;
    replace(model, entry.id, part, entry.i, entry.j);
  }
  pieces.clear();
}

bool is_elastic(const Model& model, const Column& column) {
  if (column.index < 0 || is_body_column(column.kind) || column.kind == ColumnKind::own) return false;
  if (column.index >= static_cast<int>(model.elements.size())) return false;
  const ElementRecord& record = model.elements[at(column.index)];
  const std::string_view type = model.element_type(column.index);
  return record.kind == ElementKind::force && (type == ElasticCable<double>::type || type == ElasticRope<double>::type);
}

}  // namespace

bool may_have_elastic_gaps(const Model& model) {
  const bool any = !std::get<std::vector<ElementEntry<ElasticCable<double>, double>>>(model.forces).empty() ||
                   !std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(model.forces).empty();
  const bool rubs = std::any_of(model.rope_paths.begin(), model.rope_paths.end(), [](const RopePath& path) {
    return std::any_of(path.nodes.begin(), path.nodes.end(), [](const RopeNode& node) { return node.mu > 0; });
  });
  const bool looked_at = std::any_of(model.laws.begin(), model.laws.end(), [&](const StateLaw<double>& law) {
    return std::any_of(law.inputs.begin(), law.inputs.end(),
                       [&](const Column& c) { return c.kind == ColumnKind::own || is_elastic(model, c); });
  });
  return any && !rubs && !looked_at;
}

bool is_elastic_gap(const Model& model, int element) {
  bool is = false;
  with_entry(model, element, [&](const auto& entry) { is = is_elastic_gap(model, entry); });
  return is;
}

template <class S>
std::shared_ptr<const BasicModel<S>> with_elastic_gaps(const BasicModel<S>& model) {
  auto changed = std::make_shared<BasicModel<S>>(model);
  replace_cables(*changed);
  replace_ropes(*changed);
  return changed;
}

template std::shared_ptr<const BasicModel<double>> with_elastic_gaps(const BasicModel<double>&);
template std::shared_ptr<const BasicModel<Dual<double, 4>>> with_elastic_gaps(const BasicModel<Dual<double, 4>>&);

}  // namespace catena
