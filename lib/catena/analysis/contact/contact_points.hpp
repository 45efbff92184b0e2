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
// Units: m, N, m/s; of stops and joints that turn: rad, N m, rad/s.
#pragma once

#include <limits>
#include <memory>
#include <vector>

#include "catena/model/model.hpp"

namespace catena {

enum class ContactKind : unsigned char { rigid, compliant, joint };

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

  bool has_friction() const { return slide >= 0; }
  bool is_exact() const { return smoothing == 0; }
};

/// What a place does for the time being.
struct ContactState {
  bool closed = false;  ///< a rigid one: its row holds; a compliant one: it presses; a joint always is
  int direction = 0;    ///< of exact friction: the sign of the slip, 0: it sticks

  friend bool operator==(const ContactState&, const ContactState&) = default;
};

struct ContactModel {
  std::shared_ptr<const Model> model;  ///< with the equations of slides behind the elements of the given one
  std::vector<ContactPoint> points;
};

/// The first element of a model with dry friction; -1: none.
int first_friction(const Model& model);

/// The places of a model at which it may touch; `model` is the given one where no equation had to be added.
ContactModel contact_points(std::shared_ptr<const Model> model);

}  // namespace catena
