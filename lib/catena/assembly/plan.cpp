#include "catena/assembly/plan.hpp"

#include <algorithm>
#include <numeric>

#include "catena/assembly/state_laws.hpp"
#include "catena/assembly/structure/numbering.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

std::vector<char> welds_to_keep(const Model& model, const PlanOptions& options) {
  const auto& welds = std::get<std::vector<ElementEntry<Weld<double>, double>>>(model.constraints);
  std::vector<char> keep;
  if ((options.keep_elements.empty() && options.released_elements.empty()) || welds.empty()) return keep;
  keep.assign(welds.size(), 0);
  std::vector<char> wanted(model.elements.size(), 0);
  for (int e : options.keep_elements) wanted[at(e)] = 1;
  for (int e : options.released_elements) wanted[at(e)] = 1;
  for (std::size_t k = 0; k < welds.size(); ++k) keep[k] = wanted[at(welds[k].id)];
  return keep;
}

std::vector<BodyPair> ties_of(const Model& model) {
  std::vector<BodyPair> ties;
  ties.reserve(model.elements.size());
  for_each_list(model.constraints, [&](const auto& list, int) {
    for (const auto& entry : list) {
      if (entry.i >= 0 && entry.j >= 0) ties.push_back({entry.i, entry.j});
    }
  });
  return ties;
}

void number_coordinates(const Model& model, const Elimination& elimination, Plan& plan) {
  const std::vector<BodyPair> ties = ties_of(model);
  plan.bodies = static_cast<int>(model.bodies.size());
  plan.model_body = number_bodies(plan.bodies, ties, elimination.immobile);
  plan.plan_body.resize(model.bodies.size());
  plan.column.assign(3 * model.bodies.size(), -1);
  const std::vector<int> island = find_islands(plan.bodies, ties, elimination.immobile, &plan.islands);
  for (int p = 0; p < plan.bodies; ++p) {
    const int b = plan.model_body[at(p)];
    plan.plan_body[at(b)] = p;
    plan.island.push_back(island[at(b)]);
    if (elimination.immobile[at(b)]) continue;
    ++plan.moving;
    const int unknowns = model.bodies[at(b)].particle ? 2 : 3;
    for (int k = 0; k < unknowns; ++k) {
      plan.column[at(3 * p + k)] = plan.columns++;
      plan.coordinate.push_back(3 * p + k);
    }
    plan.contiguous = plan.contiguous && unknowns == 3;
  }
  plan.body_has_row.assign(model.bodies.size(), 0);
}

// The elements of one type that have rows, sorted by their first body so that evaluation walks through memory.
template <class Entry, class Block>
void choose_elements(const std::vector<Entry>& list, const std::vector<char>& skip, const Plan& plan, Block& block) {
  const auto place = [&](int body) { return body < 0 ? plan.bodies : plan.plan_body[at(body)]; };
  block.entry.reserve(list.size());
  for (std::size_t k = 0; k < list.size(); ++k) {
    if (skip.empty() || !skip[k]) block.entry.push_back(static_cast<int>(k));
  }
  const auto first = [&](int k) { return std::min(place(list[at(k)].i), place(list[at(k)].j)); };
  if (!std::is_sorted(block.entry.begin(), block.entry.end(), [&](int a, int b) { return first(a) < first(b); })) {
    std::stable_sort(block.entry.begin(), block.entry.end(), [&](int a, int b) { return first(a) < first(b); });
  }
  block.body_i.reserve(block.entry.size());
  block.body_j.reserve(block.entry.size());
  for (int k : block.entry) {
    block.body_i.push_back(place(list[at(k)].i));
    block.body_j.push_back(place(list[at(k)].j));
  }
}

template <class E>
void number_rows(const Model& model, const std::vector<ElementEntry<E, double>>& list, ConstraintBlock<E>& block,
                 Plan& plan) {
  block.first_row = plan.rows;
  block.first_contact = plan.in_pose.contacts;
  block.first_value = plan.in_pose.values;
  if constexpr (E::functions > 0) plan.in_pose.values += block.size();
  if constexpr (SearchesCurve<E>) {
    for (const auto& entry : list) plan.element_contact[at(entry.id)] = plan.in_pose.contacts++;
  }
  for (int e = 0; e < block.size(); ++e) {
    if (block.body_i[at(e)] < plan.bodies) plan.body_has_row[at(block.body_i[at(e)])] = 1;
    if (block.body_j[at(e)] < plan.bodies) plan.body_has_row[at(block.body_j[at(e)])] = 1;
    if constexpr (Joining<E>) {
      block.joined_row.push_back(plan.element_row[at(list[at(block.entry[at(e)])].element.head)]);
      continue;
    }
    const int id = list[at(block.entry[at(e)])].id;
    plan.element_row[at(id)] = plan.rows;
    for (int r = 0; r < E::rows; ++r) {
      plan.row_element.push_back(id);
      plan.row_is_angle.push_back(row_in_angle(list[at(block.entry[at(e)])].element, r));
      if constexpr (OneSided<E> && !Dry<E>) plan.gap_rows.push_back(plan.rows + r);
    }
    plan.rows += E::rows;
    if (model.elements[at(id)].kind == ElementKind::driver) plan.driver_rows += E::rows;
  }
}

// Lists the entries of Phi_q in the order in which the slots are dealt out again below.
template <class E, class F>
void visit_entries(const ConstraintBlock<E>& block, const Plan& plan, F&& f) {
  constexpr auto pattern = jacobian_pattern<E>();
  for (int e = 0; e < block.size(); ++e) {
    for (std::size_t n = 0; n < pattern.size(); ++n) {
      if (pattern[n] == Entry::zero) continue;
      const int row = block.row(e) + static_cast<int>(n) / (3 * E::bodies);
      const int k = static_cast<int>(n) % (3 * E::bodies);
      const int body = k < 3 ? block.body_i[at(e)] : block.body_j[at(e)];
      f(pattern[n], row, body < plan.bodies ? plan.column[at(3 * body + k % 3)] : -1);
    }
  }
}

void make_slots(Plan& plan) {
  std::vector<MatrixEntry> entries;
  const auto collect = [&](Entry, int row, int column) {
    if (column >= 0) entries.push_back({row, column});
  };
  for_each_list(plan.blocks, [&](auto& block, int) { visit_entries(block, plan, collect); });
  SlottedPattern slotted = build_pattern(plan.rows, plan.columns, entries);
  plan.jacobian = std::move(slotted.pattern);
  std::size_t next = 0;
  for_each_list(plan.blocks, [&](auto& block, int) {
    visit_entries(block, plan, [&](Entry entry, int, int column) {
      const int slot = column < 0 ? plan.trash_slot() : slotted.slot[next++];
      if (entry == Entry::varying) {
        block.slot.push_back(slot);
        plan.constant_jacobian = plan.constant_jacobian && column < 0;
      } else if (column >= 0) {
        block.constant_slot.push_back(slot);
        block.constant.push_back(entry == Entry::plus_one ? 1.0 : -1.0);
      }
    });
  });
}

// Where an element does not hold, those that join it do not either.
void release_parts(const Model& model, std::vector<int>& released) {
  if (released.empty()) return;
  std::vector<char> is_released(model.elements.size(), 0);
  for (int e : released) is_released[at(e)] = 1;
  for_each_list(model.constraints, [&](const auto& list, int) {
    if constexpr (Joining<ElementOf<decltype(list)>>) {
      for (const auto& entry : list) {
        if (is_released[at(entry.element.head)] && !is_released[at(entry.id)]) released.push_back(entry.id);
      }
    }
  });
}

}  // namespace

std::shared_ptr<const Plan> Plan::make(const Model& model, const PlanOptions& options) {
  for (const std::vector<int>* numbers : {&options.keep_elements, &options.released_elements}) {
    for (int e : *numbers) static_cast<void>(model.element_type(e));  // throws for an invalid number
  }
  auto plan = std::make_shared<Plan>();
  const Elimination elimination = eliminate_bodies(model, welds_to_keep(model, options));
  number_coordinates(model, elimination, *plan);
  plan->element_row.assign(model.elements.size(), -1);
  plan->element_contact.assign(model.elements.size(), -1);
  std::vector<int> released = options.released_elements;
  if (!options.friction) {
    const std::vector<int> dry = model.frictions();
    released.insert(released.end(), dry.begin(), dry.end());
  }
  release_parts(model, released);
  if (!released.empty()) plan->released.assign(model.elements.size(), 0);
  for (int e : released) plan->released[at(e)] = 1;
  plan->row_element.reserve(2 * model.elements.size());
  plan->row_is_angle.reserve(2 * model.elements.size());
  for_each_list(model.constraints, [&](const auto& list, int type) {
    using E = ElementOf<decltype(list)>;
    auto& block = std::get<ConstraintBlock<E>>(plan->blocks);
    const bool weld = std::is_same_v<E, Weld<double>>;
    std::vector<char> skip = weld ? elimination.weld_eliminated : std::vector<char>{};
    for (int e : released) {
      const ElementRecord& record = model.elements[at(e)];
      if (record.kind == ElementKind::force || record.type != type) continue;
      skip.resize(list.size());
      skip[at(record.index)] = 1;
    }
    choose_elements(list, skip, *plan, block);
    number_rows(model, list, block, *plan);
  });
  for_each_list(model.forces, [&](const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    auto& block = std::get<ForceBlock<E>>(plan->forces);
    choose_elements(list, {}, *plan, block);
    block.first_value = plan->in_pose.loads;
    plan->in_pose.loads += E::functions * block.size();
  });
  if (!options.one_sided && !plan->gap_rows.empty()) {
    const int element = plan->row_element[at(plan->gap_rows.front())];
    throw ModelError(std::string(model.element_type(element)) + " \"" + model.element_name(element) +
                     "\" is one-sided: this analysis does not treat it; equilibrium does");
  }
  make_slots(*plan);
  for (const CompiledLaw<double>& law : compile_laws<double>(model, model.laws, *plan)) {
    // In the order in which Evaluator::visit_stiffness gives their matrices.
    for (const int read : law.bodies) {
      for (const int acted : {law.i, law.j}) {
        if (acted >= 0 && acted < plan->moving) plan->law_pairs.emplace_back(acted, read);
      }
    }
  }
  return plan;
}

}  // namespace catena
