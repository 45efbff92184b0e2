// Box2D (single precision, sequential impulses) on the problems of contact; what it prints: contact_peer.hpp.
#include <box2d/box2d.h>

#include <cstring>
#include <vector>

#include "peers/contact_peer.hpp"

namespace {

struct Settings {
  int velocity_iterations, position_iterations;
};

class World {
 public:
  World(const Settings& settings, double restitution, double friction)
      : settings_(settings),
        restitution_(static_cast<float>(restitution)),
        friction_(static_cast<float>(friction)),
        world_(b2Vec2(0.0f, static_cast<float>(-bench::contact_gravity))) {
    world_.SetAllowSleeping(false);
    b2BodyDef definition;
    b2EdgeShape floor;
    floor.SetTwoSided(b2Vec2(-1000.0f, 0.0f), b2Vec2(1000.0f, 0.0f));
    add_shape(world_.CreateBody(&definition), floor);
  }

  void add_ball(double x, double y, double radius, double mass) {
    b2Body* body = add_body(x, y, 0, false);
    add_circle(body, 0, radius);
    set_mass(body, mass, 0.5 * mass * radius * radius);
  }
  void add_dumbbell(double x, double y, double angle, double spin, double half_length, double radius, double mass,
                    double inertia) {
    b2Body* body = add_body(x, y, angle, false);
    for (const int end : {1, -1}) add_circle(body, end * half_length, radius);
    set_mass(body, mass, inertia);
    body->SetAngularVelocity(static_cast<float>(spin));
  }
  void add_block(double x, double half_size, double mass) {
    b2Body* body = add_body(x, half_size, 0, true);
    b2PolygonShape box;
    box.SetAsBox(static_cast<float>(half_size), static_cast<float>(half_size));
    add_shape(body, box);
    set_mass(body, mass, 1);
  }
  void add_link(double x, double y, double speed, double half_length, double radius, double mass, double inertia) {
    add_dumbbell(x, y, 0, 0, half_length, radius, mass, inertia);
    b2Filter apart;
    apart.groupIndex = -1;  // shapes of one negative group do not touch each other
    for (b2Fixture* f = bodies_.back()->GetFixtureList(); f; f = f->GetNext()) f->SetFilterData(apart);
    bodies_.back()->SetLinearVelocity(b2Vec2(static_cast<float>(speed), 0.0f));
    if (bodies_.size() == 1) return;
    b2RevoluteJointDef pin;
    pin.Initialize(bodies_[bodies_.size() - 2], bodies_.back(),
                   b2Vec2(static_cast<float>(x - half_length), static_cast<float>(y)));
    world_.CreateJoint(&pin);
  }

  void ready(double) {}
  void push(int body, double force) {
    bodies_[body]->ApplyForceToCenter(b2Vec2(static_cast<float>(force), 0.0f), true);
  }
  void step(double h) {
    world_.Step(static_cast<float>(h), settings_.velocity_iterations, settings_.position_iterations);
  }
  double x(int body) const { return bodies_[body]->GetWorldCenter().x; }
  double y(int body) const { return bodies_[body]->GetWorldCenter().y; }
  double angle(int body) const { return bodies_[body]->GetAngle(); }

 private:
  b2Body* add_body(double x, double y, double angle, bool upright) {
    b2BodyDef definition;
    definition.type = b2_dynamicBody;
    definition.position = b2Vec2(static_cast<float>(x), static_cast<float>(y));
    definition.angle = static_cast<float>(angle);
    definition.fixedRotation = upright;
    bodies_.push_back(world_.CreateBody(&definition));
    return bodies_.back();
  }
  void add_circle(b2Body* body, double x, double radius) {
    b2CircleShape circle;
    circle.m_p = b2Vec2(static_cast<float>(x), 0.0f);
    circle.m_radius = static_cast<float>(radius);
    add_shape(body, circle);
  }
  void add_shape(b2Body* body, const b2Shape& shape) {
    b2FixtureDef fixture;
    fixture.shape = &shape;
    fixture.density = 1;
    fixture.restitution = restitution_;
    fixture.restitutionThreshold = 0;
    fixture.friction = friction_;
    body->CreateFixture(&fixture);
  }
  static void set_mass(b2Body* body, double mass, double inertia) {
    b2MassData data;
    data.mass = static_cast<float>(mass);
    data.center.SetZero();
    data.I = static_cast<float>(inertia);
    body->SetMassData(&data);
  }

  Settings settings_;
  float restitution_, friction_;
  b2World world_;
  std::vector<b2Body*> bodies_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || std::strcmp(argv[1], "contact") != 0) return 2;
  for (const Settings& s : {Settings{8, 3}, Settings{50, 20}})
    contact_peer::run<World>(
        "Box2D",
        "float, iterations " + std::to_string(s.velocity_iterations) + "/" + std::to_string(s.position_iterations), s);
}
