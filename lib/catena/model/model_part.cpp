#include "catena/model/model_part.hpp"

#include <algorithm>
#include <limits>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/disjoint_sets.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

/// Calls f(entry, kind) for one element.
template <class F>
void with_element(const Model& model, const ElementRecord& record, F&& f) {
  const auto take = [&](const auto& list) { f(list[at(record.index)], record.kind); };
  if (record.kind == ElementKind::force) {
    with_list(model.forces, record.type, take);
  } else {
    with_list(model.constraints, record.type, take);
  }
}

/// The same for every element in file order.
template <class F>
void for_each_element(const Model& model, F&& f) {
  for (const ElementRecord& record : model.elements) with_element(model, record, f);
}

bool moves(const Model& model, int body) { return body >= 0 && !model.bodies[at(body)].fixed; }

class Extraction {
 public:
  /// `number`: of every body of the whole, -1, and again so when the part is made.
  Extraction(const Model& whole, std::vector<int>& number) : whole_(whole), body_(number) {
    part_.model.gravity = whole.gravity;
  }

  /// `elements`: those that touch the bodies, in file order.
  ModelPart make(std::span<const int> bodies, std::span<const int> elements) {
    for (const int body : bodies) add(body);
    for (const int element : elements) {
      with_element(whole_, whole_.elements[at(element)],
                   [&](const auto& entry, ElementKind kind) { add(entry, kind); });
    }
    renumber_joints();
    // Elements that are only read may tie immobile bodies: they come last, and may have laws themselves.
    for (std::size_t law = 0; law < part_.model.laws.size(); ++law) {
      std::vector<Column> inputs = part_.model.laws[law].inputs;  // a copy: more laws may come
      for (Column& input : inputs) bring(input);
      part_.model.laws[law].inputs = std::move(inputs);
    }
    for (const int body : part_.bodies) body_[at(body)] = -1;
    return std::move(part_);
  }

 private:
  int add(int body) {
    if (body < 0) return ground;
    int& number = body_[at(body)];
    if (number >= 0) return number;
    part_.bodies.push_back(body);
    return number = part_.model.append_body(whole_.body_name(body), whole_.bodies[at(body)]);
  }

  template <class E>
  void add(const ElementEntry<E, double>& entry, ElementKind kind) {
    ElementEntry<E, double> copy = entry;
    copy.i = add(entry.i);
    copy.j = add(entry.j);
    for (FunctionValue<double>& value : copy.values) {
      if (value.law >= 0) {
        part_.model.laws.push_back(whole_.laws[at(value.law)]);
        part_.model.laws.back().element = static_cast<int>(part_.model.elements.size());
        value.law = static_cast<int>(part_.model.laws.size()) - 1;
      }
      if (value.function < 0) continue;
      part_.model.functions.push_back(whole_.functions[at(value.function)]);
      value.function = static_cast<int>(part_.model.functions.size()) - 1;
    }
    renumber(copy.element);
    std::string name = whole_.element_name(entry.id);
    // The later elements of an elastic rope have no name of their own.
    if constexpr (Sharing<E>) {
      if (entry.element.pieces == 0) name.clear();
    }
    part_.model.append(name, copy, kind);
    part_.elements.push_back(entry.id);
  }

  /// Gives what a law reads its number in the part, where it is put if it is not there.
  void bring(Column& input) {
    if (input.kind == ColumnKind::time) return;
    if (is_body_column(input.kind)) {
      input.index = add(input.index);
      if (input.detail < 0) return;
      part_.model.points.push_back({-1, -1, whole_.points[at(input.detail)].local});
      input.detail = static_cast<int>(part_.model.points.size()) - 1;
      return;
    }
    auto found = std::find(part_.elements.begin(), part_.elements.end(), input.index);
    if (found == part_.elements.end()) {
      const ElementKind kind = whole_.elements[at(input.index)].kind;
      with_entry(whole_, input.index, [&](const auto& entry) { add(entry, kind); });
      found = part_.elements.end() - 1;
    }
    input.index = static_cast<int>(found - part_.elements.begin());
  }

  // Elements of a rope name each other; they follow each other in the list, all of them in this part.
  template <class E>
  void renumber(E& element) {
    if constexpr (HasParts<E>) {
      element.first_part = static_cast<int>(
          std::get<std::vector<ElementEntry<typename E::Part, double>>>(part_.model.constraints).size());
    }
    if constexpr (Joining<E>) element.head = number_of(element.head);
  }

  // Friction names its joint, which may come after it.
  void renumber_joints() {
    for_each_list(part_.model.constraints, [&](auto& list, int) {
      if constexpr (Dry<ElementOf<decltype(list)>>) {
        for (auto& entry : list) entry.element.joint = number_of(entry.element.joint);
      }
    });
  }

  // Of an element that touches the bodies, in the part.
  int number_of(int element) const {
    const auto own = std::lower_bound(part_.elements.begin(), part_.elements.end(), element);
    return static_cast<int>(own - part_.elements.begin());
  }

  const Model& whole_;
  std::vector<int>& body_;  // number in the part, -1: not there
  ModelPart part_;
};

}  // namespace

ModelPart part_of(const Model& whole, std::span<const int> bodies) {
  const std::vector<int> group(bodies.begin(), bodies.end());
  return std::move(parts_of(whole, {&group, 1}).front());
}

std::vector<ModelPart> parts_of(const Model& whole, std::span<const std::vector<int>> groups) {
  constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> group_of(whole.bodies.size(), none);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    for (const int body : groups[g]) group_of[at(body)] = g;
  }
  std::vector<std::vector<int>> elements(groups.size());
  for_each_element(whole, [&](const auto& entry, ElementKind) {
    std::size_t group = moves(whole, entry.i) ? group_of[at(entry.i)] : none;
    if (group == none && moves(whole, entry.j)) group = group_of[at(entry.j)];
    if (group != none) elements[group].push_back(entry.id);
  });
  std::vector<int> number(whole.bodies.size(), -1);
  std::vector<ModelPart> parts;
  for (std::size_t g = 0; g < groups.size(); ++g)
    parts.push_back(Extraction(whole, number).make(groups[g], elements[g]));
  return parts;
}

std::vector<std::vector<int>> separate_groups(const Model& model) {
  DisjointSets sets(static_cast<int>(model.bodies.size()));
  const auto fixed = [&](int body) { return !moves(model, body); };
  for_each_element(model, [&](const auto& entry, ElementKind) {
    if (fixed(entry.i) || fixed(entry.j)) return;
    sets.join(entry.i, entry.j);
  });
  for (const StateLaw<double>& law : model.laws) {
    int first = ground;
    const auto tie = [&](int body) {
      if (fixed(body)) return;
      if (first >= 0) sets.join(body, first);
      first = body;
    };
    const Attachment attachment = attachment_of(model, law.element);
    tie(attachment.i);
    if (attachment.bodies == 2) tie(attachment.j);
    for (const Column& input : law.inputs) visit_read_bodies(model, input, tie);
  }
  std::vector<int> group(model.bodies.size(), -1);
  std::vector<std::vector<int>> groups;
  for (int body = 0; body < static_cast<int>(model.bodies.size()); ++body) {
    if (fixed(body)) continue;
    int& number = group[at(sets.root(body))];
    if (number < 0) {
      number = static_cast<int>(groups.size());
      groups.emplace_back();
    }
    groups[at(number)].push_back(body);
  }
  return groups;
}

}  // namespace catena
