// ModelBuilder: ropes and what they run over.
#include <fmt/format.h>

#include "catena/elements/all.hpp"
#include "catena/model/rope_way.hpp"
#include "catena/scene/building/model_builder.hpp"
#include "catena/scene/describing/element_description.hpp"
#include "catena/scene/numbers/number_domain.hpp"

namespace catena {

namespace {

/// What goes on "mu" of a pulley on which no rope can rub.
std::string why_no_friction(bool rolls) {
  return rolls ? " above zero: a rope does not slide over a pulley that rolls; leave \"mu\" out, or let the rope slide"
               : " above zero: friction needs a \"radius\" above zero, round which the rope bends";
}

}  // namespace

template <class S>
void ModelBuilder<S>::append_rope(const ElementTemplate& source, const ElementEntry<Rope<S>, S>& entry) {
  const ElementDescription& type = element_descriptions()[static_cast<std::size_t>(source.type)];
  const FieldDescription& field = *type.find("over");
  const auto slot = source.first_number + static_cast<std::uint32_t>(field.slot);
  const auto& pulleys = scene_.indirect.ropes[static_cast<std::size_t>(scene_.numbers[slot].number())];
  bool good = !pulleys.empty();
  const auto wrong = [&](std::size_t offset, const std::string& what) {
    good = false;
    if (!known_wrong(offset)) report(offset, what);
  };
  RopeWay<S> way;
  way.i = {.body = entry.i, .centre = entry.element.s_i};
  way.j = {.body = entry.j, .centre = entry.element.s_j};
  for (const PulleyTemplate& pulley : pulleys) {
    const std::string name = fmt::format("pulley {} of {}", way.over.size() + 1, owner(source));
    RopePulley<S>& made = way.over.emplace_back();
    if (pulley.attachment.form == AttachmentTemplate::Form::absent ||
        !attach(pulley.attachment, nullptr, made.body, made.centre)) {
      good = false;  // reported
      continue;
    }
    if (pulley.attachment.form == AttachmentTemplate::Form::local)
      made.centre += Vec2<S>{value(pulley.place[0]), value(pulley.place[1])};
    if (pulley.has_radius) made.radius = value(pulley.radius);
    const double radius = value_of(made.radius), mu = pulley.has_mu ? value_of(value(pulley.mu)) : 0;
    if (!fits(radius, Domain::not_negative))
      wrong(pulley.radius.offset(), "\"radius\" of " + name + " " + out_of_domain(radius, Domain::not_negative));
    if (!fits(mu, Domain::not_negative)) {
      wrong(pulley.mu.offset(), "\"mu\" of " + name + " " + out_of_domain(mu, Domain::not_negative));
    } else if (mu > 0 && (pulley.rolls || radius == 0)) {
      wrong(pulley.mu.offset(), "\"mu\" of " + name + why_no_friction(pulley.rolls));
    }
    made.mu = mu;
    if (pulley.rolls && radius == 0) wrong(pulley.offset, name + " rolls: it needs a \"radius\" above zero");
    made.side = pulley.side;
    made.rolls = pulley.rolls;
    if (!pulley.rolls) continue;
    if (value_of(entry.element.length) >= 0 && !(value_of(entry.element.k) > 0))
      wrong(source.offset, name +
                               " rolls: the rope is several then, from pulley to pulley, whose lengths are those of "
                               "the given configuration; leave \"length\" out, or give a stiffness \"k\"");
  }
  if (!good) return;
  std::vector<RopeStretch<S>> stretches;
  try {
    stretches = rope_stretches(model_, way);
  } catch (const ModelError& error) {
    return wrong(source.offset, owner(source) + ": " + error.what());
  }
  name_.clear();
  if (!source.name.empty() && !make_name(source.name, name_)) return;
  try {
    add_rope<S>(model_, name_, stretches,
                {entry.element.length, entry.element.k, entry.element.restitution, entry.element.rest_speed});
  } catch (const ModelError&) {
    report_used_name(source.name, name_);
  }
  name_offset_.resize(static_cast<std::size_t>(model_.names.size()), source.name.offset);
}

template void ModelBuilder<double>::append_rope(const ElementTemplate&, const ElementEntry<Rope<double>, double>&);
template void ModelBuilder<Dual<double, 4>>::append_rope(const ElementTemplate&,
                                                         const ElementEntry<Rope<Dual<double, 4>>, Dual<double, 4>>&);

}  // namespace catena
