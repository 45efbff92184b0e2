// Collects the shapes of a mechanism while its elements are gone through, and makes the links of its bodies at the end.
//
// A link joins the places where its body is held: elements name them by attach(). Equal symbols are kept once, so that
// a chain of 10^5 links has a handful. Lengths m, local coordinates in the centroidal frames.
#pragma once

#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

#include "catena/drawing/shapes/drawing.hpp"
#include "catena/model/model.hpp"

namespace catena {

class DrawingBuilder {
 public:
  explicit DrawingBuilder(const Model& model);

  const Model& model() const { return model_; }
  /// Number of the symbol, a new one or the equal one that is known.
  int symbol(DrawnSymbol symbol);
  void add(DrawnShape shape, DrawnSymbol look) {
    shape.symbol = symbol(std::move(look));
    drawing_.shapes.push_back(shape);
  }
  void add_load(const DrawnLoad& load) { drawing_.loads.push_back(load); }
  /// `guide.shape` is set here, and `guide.member` where the guide belongs to a body that moves: what of the body
  /// bears it, `member_width` wide; zero: nothing.
  void add_guide(DrawnGuide guide, const DrawnShape& shape, DrawnSymbol look, double member_width = 0);
  void add_rope(RopePath path, DrawnSymbol look);
  /// The guides of an element along which something fixed in this body goes reach as far as this point of it does.
  void follow(int element, int body, const Vec2<double>& local);

  /// The body's link reaches to this place.
  void attach(int body, const Vec2<double>& local);
  /// A round area about a place of the body: what lies on it needs no link.
  void add_disc(int body, const Vec2<double>& centre, double radius) { discs_.push_back({body, centre, radius}); }
  /// The body has a look of its own, a gear say: without two places to join it gets no mark at its centroid.
  void has_look(int body);
  /// A pin holds these bodies together here: where a torsion spring between them is drawn.
  void add_pin(int body_i, int body_j, int body, const Vec2<double>& local);
  /// A symbol at the pin between the two bodies, or where there is none at a place on body j.
  void add_at_pin(int element, int body_i, int body_j, const Vec2<double>& otherwise, DrawnSymbol look);

  /// A toothed wheel, drawn once however many others it meshes with.
  struct Wheel {
    int body;
    Vec2<double> centre;
    double radius;
    int teeth;
    double phase;  ///< angle of a tooth in the frame of the body
  };
  /// Number of teeth of a wheel: all wheels of a model have one module.
  int teeth_of(double radius) const;
  const Wheel* find_wheel(int body, const Vec2<double>& centre, double radius) const;
  void remember(const Wheel& wheel) { wheels_.push_back(wheel); }

  /// The finished drawing, its shapes in the order of their roles.
  Drawing finish();

 private:
  struct Pin {
    int body;
    Vec2<double> local;
  };
  struct AtPin {
    int element, body_i, body_j;
    Vec2<double> otherwise;
    DrawnSymbol look;
  };
  struct Disc {
    int body;
    Vec2<double> centre;
    double radius;
  };
  void add_links();
  std::vector<Vec2<double>> beyond_discs(int body, std::vector<Vec2<double>> places) const;
  double usual_size() const;
  void add_link(int body, std::vector<Vec2<double>> places);
  void add_given_shapes();
  void add_symbols_at_pins();
  void find_typical_length();
  void sort_shapes();

  const Model& model_;
  Drawing drawing_;
  std::unordered_multimap<std::size_t, int> known_;   // symbols by a hash of their lines
  std::vector<std::pair<int, Vec2<double>>> places_;  // body and place, as they came
  std::vector<char> looks_;                           // per body
  std::map<std::pair<int, int>, Pin> pins_;
  std::vector<AtPin> at_pins_;
  std::vector<Wheel> wheels_;
  std::vector<Disc> discs_;
  double smallest_wheel_ = 0;    // radius of a gear or pinion
  std::vector<double> lengths_;  // of links
};

/// The corners of the smallest convex polygon around the points, counter-clockwise; two where all lie on a line.
std::vector<Vec2<double>> convex_hull(std::vector<Vec2<double>> points);

}  // namespace catena
