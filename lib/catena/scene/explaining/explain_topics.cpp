#include "catena/scene/explaining/explain_topics.hpp"

namespace catena {

std::span<const ExplainedTopic> explained_topics() {
  static const std::vector<ExplainedTopic> topics{
      {{"number", "quantity", "expression"},
       R"(number: how a number may be written
  0.12            SI units and radians
  "120 mm"        a quantity: begins with a digit, sign or dot; its kind must be the field's
                  m mm cm km in ft, kg g t lb, s ms min, Hz, rad deg rev, rpm, N kN lbf, Pa psi, J, W;
                  products by a space, /, ^: "6 N m/rad", "-9.81 m/s^2"
  "=crank/2+0.1"  an expression: + - * / ^ ( ) pi sin cos tan asin acos atan atan2 sqrt exp log abs min max,
                  tables as functions (catena explain tables), parameters, and k inside a replicate block; SI units
                  and radians
  "crank"         a parameter
)"},
      {{"parameters"},
       R"(parameters: names and values that the scene's numbers may use
  A value is a number (catena explain number), or has limits. Definitions may use each other in any order.

Example
  "parameters": {"crank": "100 mm", "rod": "=3*crank", "speed": {"value": "60 rpm", "min": 0, "max": 20}}
)"},
      {{"body", "bodies", "rod", "parts", "hold", "centroid", "particle"},
       R"(body: a rigid body, in "bodies" by its name
  mass, inertia      kg, kg m^2 about the centroid; may be left out where an analysis needs none
  position, angle    [x, y] m, rad: the given configuration, an estimate from which analyses assemble (default 0)
  velocity           [vx, vy] m/s of its origin, at the start of dynamics
  angular_velocity   rad/s
  points             names and places [x', y'] in the body frame, m
  centroid           [x', y'] m: the centroid in the body frame; else the frame's origin is the centroid
  parts              a list of masses {"mass", "centroid", "inertia"} or shapes {"mass", "rectangle": {"centre", "width",
                     "height", "angle"}}, {"mass", "disc": {"centre", "radius"}}, {"mass", "polygon": [[x', y'], ...]};
                     mass, inertia and centroid follow; a negative mass cuts a hole
  rod                {"from": [x, y], "to": [x, y]} in the ground frame, in place of position and angle: origin in the
                     middle, x' along it, points from and to, inertia m L^2/12 unless given
  fixed              true: stays where it is given
  particle           true: its angle stays as given, and it needs no inertia
  hold               columns that assembly may not change: "x", "y", "angle"
  draw               what it looks like in figures: shapes in the body frame as of parts, without mass, and
                     {"line": [[x', y'], ...]}; else links between the places where it is held
  The ground is the body "ground"; it may have points and draw.

Columns of a body crank and of its point tip
  crank.x [m] crank.y [m] crank.angle [rad] crank.vx [m/s] crank.vy [m/s] crank.omega [rad/s] crank.ax [m/s^2]
  crank.ay [m/s^2] crank.alpha [rad/s^2]
  crank.tip.x .y .vx .vy .ax .ay

Example
  "bodies": {"crank": {"mass": 0.5, "rod": {"from": [0, 0], "to": ["100 mm", 0]}}}
)"},
      {{"replicate"},
       R"(replicate: blocks that are repeated
  count      how often
  first      the first value of k (default 1): k runs to first + count - 1
  variable   a name to use in place of k, for blocks within blocks
  bodies, constraints, drivers, forces, replicate   what is repeated
  k may stand in expressions, "=k*l", and in names, "link{k-1}.to". Blocks and lists may name each other in any order.

Example
  "replicate": [{"count": 100, "bodies": {"link{k}": {"rod": {"from": ["=k-1", 0], "to": ["=k", 0]}}}},
                {"count": 99, "first": 2, "constraints": [{"type": "revolute", "i": "link{k-1}.to", "j": "link{k}.from"}]}]
)"},
      {{"function", "value"},
       R"(function: a function of time, for the value of a driver or the magnitude of a force
  a number, or one of polynomial, harmonic, step, law, spline, sum, product (catena explain harmonic ...)
)"},
      {{"tables"},
       R"--(tables: functions in the scene's expressions, cubic splines through points
  x, y     the points, x increasing; numbers that may depend on parameters, but not on tables
  points   in place of both: pairs [x, y], or two columns of a file (catena explain file)
  end      "natural" (default), "clamped" (zero end slopes) or "periodic"
  beyond   outside of the points, unless periodic: "error" (default), "hold" the value at the end, or go on along the
           "line" of the slope there
  Values have no units of their own: SI and radians, as everything in an expression.

Example
  "tables": {"gas": {"x": [0, 1.5, 3.14, 6.28], "y": [9e5, 2e5, 1e5, 1e5], "beyond": "hold"}}
  "torque": "=-0.1*gas(crank.angle)"
)--"},
      {{"state_law"},
       R"(state_law: the magnitude of a force as an expression over columns, parameters, tables and t
  Wherever point_force, torque, spring_damper and torsion_spring take a function of time. Columns that are known before
  accelerations are may be read: places, angles and velocities of bodies and points (crank.angle, rod.tip.vx), angle and
  omega of a revolute, slide and slide_rate along an axis, length, rate and force of a spring_damper, angle and torque
  of a torsion_spring, the torque of a torque, columns of one's own made of these. Reactions, accelerations and the
  force itself would close an algebraic loop. A name that is no plain identifier stands in single quotes:
  'long rod'.angle, in a replicate block 'link{k}'.angle.
  A law has no potential: its power (A.power) counts as work of applied loads in energy.balance. equilibrium, modes,
  path and buckling take its unsymmetric stiffness: negative omega2 are divergence, complex pairs flutter.

Example
  "forces": [{"type": "torque", "name": "motor", "i": "arm", "torque": "=-40*(arm.angle - 0.5) - 3*arm.omega"}]
)"},
      {{"follower_force", "flutter"},
       R"(follower_force: a force that turns with its body, point_force with "frame": "body"
  Such a force, and a state_law, is not minus the gradient of an energy: its stiffness is unsymmetric. equilibrium, modes,
  buckling and path judge by M x'' + K x = 0: stable where every omega2 is real and above zero. A negative omega2 is
  divergence; a pair of complex ones is flutter, an oscillation that grows. Masses decide about flutter; damping is
  left out. Refused: more than 500 degrees of freedom; in buckling and path one-sided elements beside such forces.

  modes        a pair takes two rows: omega2 (its real part) and omega (its frequency), then omega2_imaginary and growth,
               1/s, the motion that grows first
  buckling     loads of divergence, and flutter with flutter_omega, where two frequencies meet
  path         critical points of kind flutter beside limit and branch

Example
  "forces": [{"type": "point_force", "i": "rod.to", "force": [0, "=-P"], "frame": "body"}],
  "analyses": [{"type": "buckling", "parameter": "P"}]
)"},
      {{"polynomial"},
       R"(polynomial: a function of time
  f = c0 + c1 t + c2 t^2 + ...        units: those of the value, per s, per s^2 ...

Example
  {"polynomial": ["30 deg", "60 rpm"]}
)"},
      {{"harmonic"},
       R"(harmonic: a function of time
  f = offset + amplitude sin(omega t + phase)

  amplitude   in the unit of the value
  omega       rad/s
  phase       rad (default 0)
  offset      in the unit of the value (default 0)

Example
  {"harmonic": {"amplitude": "20 deg", "omega": "2 rad/s", "phase": 0, "offset": "90 deg"}}
)"},
      {{"step"},
       R"(step: a function of time that goes smoothly from one value to another
  u = (t - t0) / (t1 - t0)     order 3: 3 u^2 - 2 u^3     order 5: 10 u^3 - 15 u^4 + 6 u^5     constant outside

  t0, t1     s, t1 > t0
  from, to   in the unit of the value
  order      3: the velocity is continuous; 5 (default): the acceleration too

Example
  {"step": {"t0": 0, "t1": 0.5, "from": 0, "to": "90 deg", "order": 5}}
)"},
      {{"law"},
       R"(law: a motion law of cams, as a function of time
  a rise from one value to another in a given time, constant outside; dwells follow from sums

  type       "cycloidal" and "poly4567": smoothest; "poly345"; "modified_trapezoid": least peak acceleration;
             "modified_sine": little torque
  t0, t1     s, t1 > t0
  from, to   in the unit of the value

Example
  {"law": {"type": "modified_sine", "t0": 0, "t1": 0.5, "from": 0, "to": "90 deg"}}
)"},
      {{"spline"},
       R"(spline: a cubic spline through a table, as a function of time
  t       times, increasing, s
  value   the values there
  points  in place of both: pairs [t, value], or two columns of a file (catena explain file)
  end     "natural" (default), "clamped" (zero end slopes) or "periodic"
  beyond  outside of the table, unless periodic: "error" (default), "hold" the value at the end, or go on along the
          "line" of the slope there

Example
  {"spline": {"t": [0, 0.5, 1], "value": [0, 0.2, 0], "end": "clamped"}}

spline: a curve through points of a body frame, the chord length as parameter
  points   [[x', y'], ...], m, or two columns of a file (catena explain file)
  end      "natural" (default) or "periodic"
  beyond   the ends, unless periodic: "error" (default); "line": the curve goes on straight; "hold": its end stays the
           point of contact, for a follower along the tangent there (cam_cam cannot)

Example
  {"spline": {"points": [[0.1, 0], [0, 0.1], [-0.1, 0], [0, -0.1]], "end": "periodic"}}
)"},
      {{"file"},
       R"(file: columns of a CSV file, in place of a list of numbers or of pairs; or its keys beside "end" and "beyond" of a
      spline, polar curve or table, in place of both of its lists
  file     its path, relative to the scene's folder; numbers separated by commas, semicolons, tabs or blanks; empty
           lines, those that begin with #, and a first line of names are left out
  columns  numbers from 1, or names in the file's first line (default: the first ones)
  unit     of each column (default: SI and radians)
  smooth   of measured pairs: the root mean square by which values may be moved to make the curve smoother, a quantity
           or a number in the unit of the last column (default: 0); how far they were moved stands in the warnings

Example
  {"spline": {"points": {"file": "lift.csv", "columns": ["angle", "lift"], "unit": ["deg", "mm"], "smooth": 0.02}}}
  {"polar": {"file": "cam.csv", "unit": ["deg", "mm"]}}
)"},
      {{"sum", "product"},
       R"(sum, product: functions of time made of others
  A list of numbers and functions; in a product the kinds of quantity are not checked.

Example
  {"sum": [{"polynomial": [0, "10 rad/s"]}, {"harmonic": {"amplitude": "2 deg", "omega": "60 rad/s"}}]}
)"},
      {{"curve", "circle", "polar", "line"},
       R"(curve: a curve fixed in a body frame
  {"circle": {"centre": [x', y'], "radius": r}}            counter-clockwise
  {"spline": {"points": [[x', y'], ...], "end": "natural" or "periodic", "beyond": "error", "hold" or "line"}}
  {"polar": {"angle": [...], "radius": [...]}}             periodic, about the body's origin; or "points", pairs of both
  {"line": {"point": [x', y'], "axis": [vx', vy']}}
)"},
      {{"outputs", "columns"},
       R"(outputs: which columns the rows of results have
  crank.x, crank.tip.vx       of bodies and their points (catena explain body)
  A.fx, drive.load, s.force   of elements (catena explain revolute, ...)
  energy.total, momentum.x    of the whole mechanism (catena explain energy)
  A bare crank, crank.tip, A.reaction or energy stands for all of its columns. t is always the first of timed analyses.
  A column that an analysis cannot give is left out, with a note. Default: x, y and angle of every body.

Example
  "outputs": ["crank.angle", "rod.tip.x", "A.reaction", "energy"]
)"},
      {{"reaction", "fx", "fy", "lambda1", "load", "power", "work"},
       R"(reaction: what a constraint A exerts
  A.fx A.fy [N], A.torque [N m]   on body j (on the only body of an absolute constraint), ground axes, torque about P_j
  A.i.fx A.i.fy A.i.torque        on body i, about P_i
  A.joint.fx A.joint.fy           on body j in the joint's axes
  A.lambda1 ...                   multipliers of the published equations
  A.reaction                      all of the first three groups
  Of a bushing B: B.fx B.fy B.torque and B.joint.fx B.joint.fy (axes of body i) are what it exerts on body j at P_j;
  B.dx B.dy is the offset of P_j from P_i in those axes, B.angle the angle of j measured from i.

load: of a driver, load = lambda dPhi/dc, so that power = load dc/dt: positive pushes the value up
  drive.load, drive.power [W], drive.work [J]
work is summed up from the start of an analysis: in dynamics along with the motion, to its tolerance; in
inverse_dynamics to about 1e-10 of the energy exchanged, however far apart rows are; energy.balance shows the error
)"},
      {{"gap", "one-sided"},
       R"(gap: of a contact, stop or cable A, which push or pull one way only
  A.gap [m, rad]     how far it is from closing; never negative at an equilibrium, but for an elastic cable's stretch
  A.force [N, N m]   what keeps it from closing, never negative: normal force, torque of the bound, tension
  A.friction [N], A.slip [m/s]   of a contact in motion, along the curve's direction, on j relative to i
  A.force_j [N]      of a rope, its tension at j: with friction on pulleys (mu, in motion) it differs from that at i
  At an equilibrium one of gap and force is zero. The result "active" lists those whose gap is closed. In dynamics they
  close with impacts, or press by a stiffness k, rub and open again: "events" lists every change. kinematics, check and
  assemble leave them out and say which are violated; modes, buckling and path take those that hold at rest ("active"),
  and path follows them: "changes" lists what closes and opens (elastic cables are springs, which every analysis knows).
)"},
      {{"energy", "momentum", "residual", "t"},
       R"(energy, momentum, residual: columns of the whole mechanism
  energy.kinetic .potential .total .dissipated .balance [J]   zero of the potential at the ground's origin;
                               balance = total - initial total - work of drivers and loads + dissipated
  momentum.x momentum.y [kg m/s], momentum.angular [kg m^2/s] about the ground's origin
  residual                     largest constraint residual, m (angles times the mean distance of attachment points);
                               rad where every constraint is an angle
  t                            time, s
)"},
      {{"analyses", "set", "from"},
       R"(analyses: what `catena run` does, in order
  Each starts from the state and time where the one before ended, or with "from": "initial" from the given configuration
  at t = 0. "set": {"P": 3} gives parameters other values for one analysis. One that fails ends the run, unless the next
  has "from": "initial".

Example
  "analyses": [{"type": "check"}, {"type": "kinematics", "until": 1, "every": 0.01}]
)"},
      {{"events"},
       R"(events: what kinematics, inverse_dynamics and dynamics watch for
  name        in the results (default: event#n)
  when        a column, or an expression of columns
  value       at which it happens, SI units and radians (default 0)
  direction   "any" (default), "up" or "down"
  action      "record" (default): nothing but a row; "stop": the analysis ends there, the next goes on from there;
              "release": a constraint ceases to hold; "engage": a constraint begins to hold, and does not before
              unless an event that stands before this one in the list releases it;
              "impulse": a blow, which needs the key of that name and is meant where that stands alone
  element     the constraint or driver that is released or engaged
  impulse     in dynamics: {"i": point, "value": [px, py]}, a blow in ground axes, N s
  Every event gets a row of its own between the others, and an entry {"name", "t", "row", "kind"} in the result "events";
  rows count from 0. Those of one instant come and act in the order of the list. A column that starts at its value has
  no event there. What engages must hold already, to 1e-6 of the scene's size; velocities then change as in a plastic
  impact, and the energy lost counts as dissipated. Where they jump, by that, a blow or a driver (kind "jump"), the
  result "impulses" has what constraints exert, N s. In kinematics a motion must be determined after a release;
  inverse_dynamics has "record" and "stop" alone.
  "replicate" beside "events" repeats some: {"count": N, "first": 1, "variable": "k", "events": [...]}; names, columns
  and elements may hold {expressions} of k.

Example
  "events": [{"name": "landing", "when": "ball.y", "value": 0.1, "direction": "down", "action": "stop"}],
  "replicate": [{"count": 8, "events": [{"name": "tooth{k}", "when": "=wheel.angle - 2*pi*k/8"}]}]
)"},
      {{"measures"},
       R"(measures: what a motion or a state is worth, one number each; sensitivity, optimise and sweep take them
  max, min, range, mean, rms, integral    a column or "=expression" over the motion, between its rows as well
  first, final                            at the first and the last instant
  at, of                                  of a column at an instant
  path, to, timed                         root mean square distance of a path [x, y] from places [[x, y], ...]
  field                                   a number among the results: "energy", "omega[1]", "loads[1]"

Example
  "measures": {"reach": {"range": "coupler.pen.x"}, "late": {"at": 0.2, "of": "rocker.omega"}}
)"},
      {{"gravity"}, "gravity: [gx, gy] in m/s^2, default [0, 0]\n\nExample\n  \"gravity\": [0, -9.81]\n"},
  };
  return topics;
}

}  // namespace catena
