// The places at which a motion may press, hit, stick and slip, and the equations that stand for them.
//
//   gap    g(q) >= 0 of a one-sided element; its row holds while the place is closed
//   slide  w(q): how far the touching material points have moved along each other; its row holds while the place sticks
//
// A contact with friction and a joint with friction get an equation for their slide, which the model itself does not
// have: contact_points() appends it to a copy. Rigid places close by a row, compliant ones by a force
//
//   N = k d^n + c d',   d = -g        pressing while d > 0 and N > 0
//
// Where a rope with friction slides over pulleys, a grip (rope_grips.hpp) is a place of its own: what presses there is
// the tension, and it is closed while the rope is taut.
//
// Units: m, N, m/s; of stops and joints that turn: rad, N m, rad/s.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "catena/analysis/contact/rope_grips.hpp"
#include "catena/model/model.hpp"

namespace catena {

enum class ContactKind : unsigned char { rigid, compliant, joint, grip };

/// The grips of one rope among the places of a model.
struct RopePlaces {
  int head = -1;                     ///< of an inextensible rope, its own place, before those of its grips
  std::vector<std::size_t> grips{};  ///< from the end i on
  int whole = -1;                    ///< of an elastic one, the element of what it lacks to being taut
  double k = 0;                      ///< its stiffness, N/m; zero: inextensible
  double length = 0;                 ///< of its way at the start of the motion, m
  std::vector<double> yields{};      ///< of its parts between grips, m/N
};

struct ContactPoint {
  int element = -1;  ///< the one-sided element, or the joint's friction
  ContactKind kind = ContactKind::rigid;
  double restitution = 0;
  double rest_speed = -1;  ///< below it a rebound is none; negative: a part of the speed of the motion
  double k = 0, c = 0, exponent = 1;
  double mu = 0, mu_static = 0;
  double smoothing = 0;  ///< vs: friction is mu N tanh(slip / vs); 0: exact
  int slide = -1;        ///< number of the slide's equation in the expanded model, -1: no friction
  int joint = -1;        ///< whose reaction presses, for the friction of a joint
  double radius = 1;     ///< of the pin, m: friction is a torque mu N radius; 1 where a joint slides
  double half_length = std::numeric_limits<double>::infinity();  ///< of a guide: its moment counts as moment / this
  bool turns = false;                                            ///< its gap, or its slide, is an angle
  std::shared_ptr<const GripLines> lines = nullptr;              ///< of a grip
  std::shared_ptr<const RopePlaces> rope = nullptr;              ///< of a grip: the rope's

  bool has_friction() const { return lines ? lines->touches() : slide >= 0; }
  bool is_exact() const { return smoothing == 0; }
  /// A grip whose rope has a stiffness: its tensions follow from places and from how much rope has passed.
  bool is_elastic_grip() const { return rope && rope->k > 0; }
};

/// What a place does for the time being.
struct ContactState {
  bool closed = false;  ///< a rigid one: its row holds; a compliant one: it presses; a joint always is; a grip: taut
  int direction = 0;    ///< of exact friction: the sign of the slip, 0: it sticks
  double held = 0;      ///< of an elastic rope's grip that sticks: u and the stretch behind it, m; see also `tied`
  /// Others keep it from slipping, and its share of what is held is not unique. As long as they do it stays as it was
  /// found: of a grip without stiffness T_out / T_in = e^held, of a joint the friction held N, or held times that of
  /// another point.
  bool tied = false;
  int master = -1;  ///< that point; see same_slides.hpp

  friend bool operator==(const ContactState&, const ContactState&) = default;
};

struct ContactModel {
  std::shared_ptr<const Model> model;  ///< with the equations of slides behind the elements of the given one
  std::vector<ContactPoint> points;
  std::vector<GrippedRope> ropes{};  ///< with grips, and where these are among the points
  std::vector<std::shared_ptr<RopePlaces>> places{};
};

/// Lays the grips of the model's ropes as these lie, and lets their points know. Throws ModelError, as lay().
void lay_grips(ContactModel& contacts, const std::vector<RopeRoute>& routes,
               const std::function<std::vector<Frame<double>>(const RopeRoute&)>& frames);

/// Joints with friction alone, as the contacts of a driven motion take no part in it.
std::vector<ContactPoint> joints_with_friction(const Model& model);

/// The first element of a model with dry friction; -1: none.
int first_friction(const Model& model);

/// The places of a model at which it may touch; `model` is the given one where no equation had to be added.
ContactModel contact_points(std::shared_ptr<const Model> model);

}  // namespace catena
