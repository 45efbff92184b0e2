// Open Dynamics Engine (double precision) on the problems of contact: dWorldStep (direct) and dWorldQuickStep (SOR);
// bodies are kept in the plane by dJointPlane2D. What it prints: contact_peer.hpp.
#include <ode/ode.h>

#include <cstring>
#include <vector>

#include "peers/contact_peer.hpp"

static_assert(sizeof(dReal) == sizeof(double), "the double precision build of ODE is expected");

namespace {

struct Settings {
  int quick_iterations;  // 0: the direct solver
};

class World {
 public:
  World(const Settings& settings, double restitution, double friction)
      : settings_(settings),
        restitution_(restitution),
        friction_(friction),
        world_(dWorldCreate()),
        space_(dSimpleSpaceCreate(nullptr)),
        contacts_(dJointGroupCreate(0)) {
    dWorldSetGravity(world_, 0, -bench::contact_gravity, 0);
    dWorldSetAutoDisableFlag(world_, 0);
    dWorldSetCFM(world_, 1e-12);
    if (settings_.quick_iterations > 0) dWorldSetQuickStepNumIterations(world_, settings_.quick_iterations);
    floor_ = dCreatePlane(space_, 0, 1, 0, 0);
  }
  World(const World&) = delete;
  World& operator=(const World&) = delete;
  ~World() {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
  }

  void add_ball(double x, double y, double radius, double mass) {
    add_sphere(add_body(x, y, mass, 0.4 * mass * radius * radius), 0, radius);
  }
  void add_dumbbell(double x, double y, double angle, double spin, double half_length, double radius, double mass,
                    double inertia) {
    dBodyID body = add_body(x, y, mass, inertia);
    dMatrix3 turned;
    dRFromAxisAndAngle(turned, 0, 0, 1, angle);
    dBodySetRotation(body, turned);
    dBodySetAngularVel(body, 0, 0, spin);
    for (const int end : {1, -1}) add_sphere(body, end * half_length, radius);
  }
  void add_block(double x, double half_size, double mass) {
    dBodyID body = add_body(x, half_size, mass, mass);
    dBodySetMaxAngularSpeed(body, 0);
    dGeomID box = dCreateBox(space_, 2 * half_size, 2 * half_size, 2 * half_size);
    dGeomSetBody(box, body);
  }
  void add_link(double x, double y, double speed, double half_length, double radius, double mass, double inertia) {
    add_dumbbell(x, y, 0, 0, half_length, radius, mass, inertia);
    dBodySetLinearVel(bodies_.back(), speed, 0, 0);
    if (bodies_.size() == 1) return;
    dJointID pin = dJointCreateHinge(world_, nullptr);
    dJointAttach(pin, bodies_[bodies_.size() - 2], bodies_.back());
    dJointSetHingeAnchor(pin, x - half_length, y, 0);
    dJointSetHingeAxis(pin, 0, 0, 1);
  }

  void ready(double) {}
  void push(int body, double force) { dBodyAddForce(bodies_[body], force, 0, 0); }
  void step(double h) {
    dSpaceCollide(space_, this, [](void* self, dGeomID a, dGeomID b) { static_cast<World*>(self)->touch(a, b); });
    if (settings_.quick_iterations > 0)
      dWorldQuickStep(world_, h);
    else
      dWorldStep(world_, h);
    dJointGroupEmpty(contacts_);
  }
  double x(int body) const { return dBodyGetPosition(bodies_[body])[0]; }
  double y(int body) const { return dBodyGetPosition(bodies_[body])[1]; }
  double angle(int body) const {
    const dReal* turned = dBodyGetRotation(bodies_[body]);
    return std::atan2(turned[4], turned[0]);
  }

 private:
  dBodyID add_body(double x, double y, double mass, double inertia) {
    dBodyID body = dBodyCreate(world_);
    dMass of;
    dMassSetParameters(&of, mass, 0, 0, 0, inertia, inertia, inertia, 0, 0, 0);
    dBodySetMass(body, &of);
    dBodySetPosition(body, x, y, 0);
    dJointAttach(dJointCreatePlane2D(world_, nullptr), body, nullptr);
    bodies_.push_back(body);
    return body;
  }
  void add_sphere(dBodyID body, double x, double radius) {
    dGeomID sphere = dCreateSphere(space_, radius);
    dGeomSetBody(sphere, body);
    dGeomSetOffsetPosition(sphere, x, 0, 0);
  }
  void touch(dGeomID a, dGeomID b) {
    if (a != floor_ && b != floor_) return;
    dContactGeom points[4];
    const int count = dCollide(a, b, 4, points, sizeof(dContactGeom));
    for (int k = 0; k < count; ++k) {
      dContact contact{};
      contact.geom = points[k];
      contact.surface.mode = dContactBounce | dContactApprox1;
      contact.surface.mu = friction_;
      contact.surface.bounce = restitution_;
      contact.surface.bounce_vel = 0;
      dJointID joint = dJointCreateContact(world_, contacts_, &contact);
      dJointAttach(joint, dGeomGetBody(a), dGeomGetBody(b));
    }
  }

  Settings settings_;
  double restitution_, friction_;
  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  dGeomID floor_;
  std::vector<dBodyID> bodies_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || std::strcmp(argv[1], "contact") != 0) return 2;
  dInitODE2(0);
  contact_peer::run<World>("ODE", "dWorldStep", Settings{0});
  contact_peer::run<World>("ODE", "dWorldQuickStep 20", Settings{20});
  dCloseODE();
}
