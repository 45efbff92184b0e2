#include "catena/model/model_part.hpp"

#include <algorithm>
#include <numeric>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

/// Calls f(entry, kind) for every element in file order.
template <class F>
void for_each_element(const Model& model, F&& f) {
  for (const ElementRecord& record : model.elements) {
    const auto take = [&](const auto& list) { f(list[at(record.index)], record.kind); };
    if (record.kind == ElementKind::force) {
      with_list(model.forces, record.type, take);
    } else {
      with_list(model.constraints, record.type, take);
    }
  }
}

class Extraction {
 public:
  explicit Extraction(const Model& whole) : whole_(whole), body_(whole.bodies.size(), -1) {
    part_.model.gravity = whole.gravity;
  }

  ModelPart make(std::span<const int> bodies) {
    for (const int body : bodies) add(body);
    for_each_element(whole_, [&]<class E>(const ElementEntry<E, double>& entry, ElementKind kind) {
      const bool ours = (moves(entry.i) && body_[at(entry.i)] >= 0) || (moves(entry.j) && body_[at(entry.j)] >= 0);
      if (ours) add(entry, kind);
    });
    // Elements that are only read may tie immobile bodies: they come last, and may have laws themselves.
    for (std::size_t law = 0; law < part_.model.laws.size(); ++law) {
      std::vector<Column> inputs = part_.model.laws[law].inputs;  // a copy: more laws may come
      for (Column& input : inputs) bring(input);
      part_.model.laws[law].inputs = std::move(inputs);
    }
    return std::move(part_);
  }

 private:
  bool moves(int body) const { return body >= 0 && !whole_.bodies[at(body)].fixed; }

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
    if constexpr (Joining<E>) {
      const auto head = std::lower_bound(part_.elements.begin(), part_.elements.end(), element.head);
      element.head = static_cast<int>(head - part_.elements.begin());
    }
  }

  const Model& whole_;
  std::vector<int> body_;  // number in the part, -1: not there
  ModelPart part_;
};

}  // namespace

ModelPart part_of(const Model& whole, std::span<const int> bodies) { return Extraction(whole).make(bodies); }

std::vector<std::vector<int>> separate_groups(const Model& model) {
  std::vector<int> leader(model.bodies.size());
  std::iota(leader.begin(), leader.end(), 0);
  const auto find = [&](int body) {
    while (leader[at(body)] != body) body = leader[at(body)] = leader[at(leader[at(body)])];
    return body;
  };
  const auto fixed = [&](int body) { return body < 0 || model.bodies[at(body)].fixed; };
  for_each_element(model, [&](const auto& entry, ElementKind) {
    if (fixed(entry.i) || fixed(entry.j)) return;
    leader[at(find(entry.i))] = find(entry.j);
  });
  for (const StateLaw<double>& law : model.laws) {
    int first = ground;
    const auto tie = [&](int body) {
      if (fixed(body)) return;
      if (first >= 0) leader[at(find(body))] = find(first);
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
    int& number = group[at(find(body))];
    if (number < 0) {
      number = static_cast<int>(groups.size());
      groups.emplace_back();
    }
    groups[at(number)].push_back(body);
  }
  return groups;
}

}  // namespace catena
