// Chipmunk2D (double precision, sequential impulses) on the problems of contact; what it prints: contact_peer.hpp.
#include <chipmunk/chipmunk.h>

#include <cstring>
#include <vector>

#include "peers/contact_peer.hpp"

namespace {

struct Settings {
  int iterations;
};

class World {
 public:
  World(const Settings& settings, double restitution, double friction)
      : space_(cpSpaceNew()), restitution_(restitution), friction_(friction) {
    cpSpaceSetGravity(space_, cpv(0, -bench::contact_gravity));
    cpSpaceSetIterations(space_, settings.iterations);
    cpSpaceSetCollisionSlop(space_, 0);
    add_shape(cpSegmentShapeNew(cpSpaceGetStaticBody(space_), cpv(-1000, 0), cpv(1000, 0), 0), 1);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() {
    for (cpConstraint* pin : pins_) {
      cpSpaceRemoveConstraint(space_, pin);
      cpConstraintFree(pin);
    }
    for (cpShape* shape : shapes_) {
      cpSpaceRemoveShape(space_, shape);
      cpShapeFree(shape);
    }
    for (cpBody* body : bodies_) {
      cpSpaceRemoveBody(space_, body);
      cpBodyFree(body);
    }
    cpSpaceFree(space_);
  }

  void add_ball(double x, double y, double radius, double mass) {
    cpBody* body = add_body(x, y, mass, cpMomentForCircle(mass, 0, radius, cpvzero));
    add_shape(cpCircleShapeNew(body, radius, cpvzero), restitution_);
  }
  void add_dumbbell(double x, double y, double angle, double spin, double half_length, double radius, double mass,
                    double inertia) {
    cpBody* body = add_body(x, y, mass, inertia);
    cpBodySetAngle(body, angle);
    cpBodySetAngularVelocity(body, spin);
    for (const int end : {1, -1}) add_shape(cpCircleShapeNew(body, radius, cpv(end * half_length, 0)), restitution_);
  }
  void add_block(double x, double half_size, double mass) {
    cpBody* body = add_body(x, half_size, mass, INFINITY);
    add_shape(cpBoxShapeNew(body, 2 * half_size, 2 * half_size, 0), restitution_);
  }
  void add_link(double x, double y, double speed, double half_length, double radius, double mass, double inertia) {
    const std::size_t first = shapes_.size();
    add_dumbbell(x, y, 0, 0, half_length, radius, mass, inertia);
    // Shapes of one group do not touch each other.
    for (std::size_t k = first; k < shapes_.size(); ++k)
      cpShapeSetFilter(shapes_[k], cpShapeFilterNew(1, CP_ALL_CATEGORIES, CP_ALL_CATEGORIES));
    cpBodySetVelocity(bodies_.back(), cpv(speed, 0));
    if (bodies_.size() == 1) return;
    pins_.push_back(cpSpaceAddConstraint(
        space_, cpPivotJointNew(bodies_[bodies_.size() - 2], bodies_.back(), cpv(x - half_length, y))));
  }

  void ready(double) {}
  void push(int body, double force) { cpBodySetForce(bodies_[body], cpv(force, 0)); }
  void step(double h) { cpSpaceStep(space_, h); }
  double x(int body) const { return cpBodyGetPosition(bodies_[body]).x; }
  double y(int body) const { return cpBodyGetPosition(bodies_[body]).y; }
  double angle(int body) const { return cpBodyGetAngle(bodies_[body]); }

 private:
  cpBody* add_body(double x, double y, double mass, double inertia) {
    cpBody* body = cpSpaceAddBody(space_, cpBodyNew(mass, inertia));
    cpBodySetPosition(body, cpv(x, y));
    bodies_.push_back(body);
    return body;
  }
  /// Restitution and friction of a pair are the products of both shapes' own.
  void add_shape(cpShape* shape, double restitution) {
    cpShapeSetElasticity(shape, restitution);
    cpShapeSetFriction(shape, std::sqrt(friction_));
    shapes_.push_back(cpSpaceAddShape(space_, shape));
  }

  cpSpace* space_;
  double restitution_, friction_;
  std::vector<cpBody*> bodies_;
  std::vector<cpShape*> shapes_;
  std::vector<cpConstraint*> pins_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || std::strcmp(argv[1], "contact") != 0) return 2;
  for (const int iterations : {10, 100})
    contact_peer::run<World>("Chipmunk", "iterations " + std::to_string(iterations), Settings{iterations});
}
