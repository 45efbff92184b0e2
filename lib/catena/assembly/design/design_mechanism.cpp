#include "catena/assembly/design/design_mechanism.hpp"

#include <algorithm>
#include <stdexcept>

#include "catena/assembly/curve_contacts.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

// The pose that a weld gives one body when the other one's is known; see elimination.cpp.
Frame<DesignScalar> welded_pose(const Weld<DesignScalar>& weld, const Frame<DesignScalar>& known, bool forward) {
  const DesignScalar angle = forward ? known.phi + weld.angle : known.phi - weld.angle;
  const Vec2<DesignScalar> place = known.point(forward ? weld.s_i : weld.s_j);
  Frame<DesignScalar> pose = make_frame(DesignScalar(0.0), DesignScalar(0.0), angle);
  const Vec2<DesignScalar> arm = pose.axis(forward ? weld.s_j : weld.s_i);
  pose.x = place.x - arm.x;
  pose.y = place.y - arm.y;
  return pose;
}

}  // namespace

DesignMechanism::~DesignMechanism() = default;
DesignMechanism::DesignMechanism(DesignMechanism&&) noexcept = default;

DesignMechanism::DesignMechanism(const Evaluator& evaluator, std::shared_ptr<const DesignModel> model)
    : plan_(evaluator.shared_plan()), model_(std::move(model)) {
  if (!model_ || model_->bodies.size() != evaluator.model().bodies.size() ||
      model_->elements.size() != evaluator.model().elements.size())
    throw std::invalid_argument("a model with derivatives must have the bodies and elements of the one it belongs to");
  for (int p = 0; p <= plan_->bodies; ++p) origin_.push_back(p < plan_->bodies ? evaluator.origin(p) : Vec2<double>{});
  scale_.assign(model_->elements.size(), 1.0);
  place_.assign(model_->elements.size(), -1);
  for_each_list(plan_->blocks, model_->constraints, [&](const auto& block, const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    for (int e = 0; e < block.size(); ++e) {
      const int id = list[at(block.entry[at(e)])].id;
      place_[at(id)] = e;
      if constexpr (HasSquaredValue<E>) scale_[at(id)] = evaluator.element_jacobian(id).scale;
    }
  });
  function_.resize(model_->functions.size());
  laws_ = compile_laws<DesignScalar>(*model_, evaluator.model().laws, *plan_);
  motion_.resize(at(plan_->bodies) + 1);
  place_immobile_bodies();
  contacts_.resize(at(plan_->in_pose.contacts));
  for_each_contact(*plan_, model_->constraints, contacts_,
                   [&](const auto& entry, CurvePlace& contact) { contact = evaluator.contact(entry.id); });
}

// Breadth first from what is fixed, along the welds that were eliminated: as the plan has it.
void DesignMechanism::place_immobile_bodies() {
  const auto& welds = std::get<std::vector<ElementEntry<Weld<DesignScalar>, DesignScalar>>>(model_->constraints);
  const std::size_t bodies = model_->bodies.size();
  const auto place_of = [&](int body) { return body < 0 ? bodies : at(body); };
  std::vector<std::vector<int>> welds_of(bodies + 1);
  for (std::size_t k = 0; k < welds.size(); ++k) {
    if (plan_->element_row[at(welds[k].id)] >= 0 || plan_->is_released(welds[k].id)) continue;
    welds_of[place_of(welds[k].i)].push_back(static_cast<int>(k));
    welds_of[place_of(welds[k].j)].push_back(static_cast<int>(k));
  }
  std::vector<Frame<DesignScalar>> pose(bodies);
  std::vector<char> known(bodies, 0);
  std::vector<int> queue = {ground};
  for (std::size_t b = 0; b < bodies; ++b) {
    if (!model_->bodies[b].fixed) continue;
    pose[b] = model_->frame(static_cast<int>(b));
    known[b] = 1;
    queue.push_back(static_cast<int>(b));
  }
  for (std::size_t head = 0; head < queue.size(); ++head) {
    const int body = queue[head];
    const Frame<DesignScalar> here = body < 0 ? Frame<DesignScalar>{} : pose[at(body)];
    for (const int k : welds_of[place_of(body)]) {
      const bool forward = welds[at(k)].i == body;
      const int other = forward ? welds[at(k)].j : welds[at(k)].i;
      if (other < 0 || known[at(other)]) continue;
      pose[at(other)] = welded_pose(welds[at(k)].element, here, forward);
      known[at(other)] = 1;
      queue.push_back(other);
    }
  }
  for (int p = plan_->moving; p < plan_->bodies; ++p) {
    Frame<DesignScalar> f = pose[at(plan_->model_body[at(p)])];
    f.x = f.x - DesignScalar(origin_[at(p)].x);
    f.y = f.y - DesignScalar(origin_[at(p)].y);
    motion_[at(p)] = {f.x, f.y, f.phi, f.c, f.s};
  }
}

void DesignMechanism::set_time(double t, Side side) {
  time_ = t;
  for (std::size_t k = 0; k < function_.size(); ++k) {
    const TimeRange domain = model_->functions[k].domain();
    const double there = std::clamp(t, domain.first, domain.last);
    // At the inner knots of a table derivatives by parameters have two sides, the function itself has one.
    function_[k] = side == Side::after ? model_->functions[k].evaluate(there)
                                       : model_->functions[k].continue_from(there, side, there);
  }
}

void DesignMechanism::freeze_time(double t) {
  set_time(t);
  for (Taylor<DesignScalar>& function : function_) function = function.f;
}

void DesignMechanism::lift_configuration(std::span<const double> q, std::span<DesignScalar> out) const {
  for (std::size_t c = 0; c < q.size(); ++c) out[c] = q[c];
  for (int p = 0; p < plan_->moving; ++p) {
    // The angle of a particle stays as given.
    if (plan_->column[at(3 * p + 2)] < 0) out[at(3 * p + 2)].d = model_->bodies[at(plan_->model_body[at(p)])].angle.d;
  }
}

void DesignMechanism::set_state(std::span<const DesignScalar> q, std::span<const DesignScalar> qd,
                                std::span<const DesignScalar> qdd) {
  const DesignScalar none;
  for (int p = 0; p < plan_->moving; ++p) {
    const std::size_t c = at(3 * p);
    const Frame<DesignScalar> f = make_frame(q[c], q[c + 1], q[c + 2]);
    Frame<Taylor<DesignScalar>>& m = motion_[at(p)];
    m = qd.empty() ? moving(f, none, none, none) : moving(f, qd[c], qd[c + 1], qd[c + 2]);
    if (qdd.empty()) continue;
    m.x.dd += qdd[c];
    m.y.dd += qdd[c + 1];
    m.phi.dd += qdd[c + 2];
    m.c.dd -= f.s * qdd[c + 2];
    m.s.dd += f.c * qdd[c + 2];
  }
  follow_contacts(
      *plan_, model_->constraints, origin_,
      [this](int body) {
        const Frame<Taylor<DesignScalar>>& m = motion_[at(body)];
        return Frame<double>{m.x.f.v, m.y.f.v, m.phi.f.v, m.c.f.v, m.s.f.v};
      },
      contacts_);
}

Frame<DesignScalar> DesignMechanism::ground_frame(int plan_body) const {
  const Frame<Taylor<DesignScalar>>& m = motion_[at(plan_body)];
  return {m.x.f + DesignScalar(origin_[at(plan_body)].x), m.y.f + DesignScalar(origin_[at(plan_body)].y), m.phi.f,
          m.c.f, m.s.f};
}

const DesignScalar& DesignMechanism::mass(int coordinate) const {
  const auto& body = model_->bodies[at(plan_->model_body[at(coordinate / 3)])];
  return coordinate % 3 == 2 ? body.inertia : body.mass;
}

}  // namespace catena
