#include "catena/model/attachment.hpp"

#include <gtest/gtest.h>

#include "catena/elements/constraints/revolute.hpp"

namespace catena::testing {
namespace {

/// A joint with every kind of field an attachment is read from.
template <class S = double>
struct Slider {
  static constexpr std::string_view type = "slider";
  static constexpr int rows = 1, bodies = 2, functions = 0;
  Vec2<S> s_i, s_j, v_i, w_j, centre;
  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &Slider::s_i, 0, ""}, PointField{"j", &Slider::s_j, 1, ""},
                           AxisField{"axis_i", &Slider::v_i, 0, true, ""},
                           AxisField{"axis_j", &Slider::w_j, 1, false, ""}, PlaceField{"ground", &Slider::centre, ""});
  }
};

TEST(Attachment, IsReadFromTheFieldsOfAnyType) {
  ElementEntry<Slider<>, double> entry{{{1, 2}, {3, 4}, {0.6, 0.8}, {0, 1}, {9, 9}}, 5, 7};
  const Attachment a = attachment_of(entry);
  EXPECT_EQ(a.bodies, 2);
  EXPECT_EQ(a.i, 5);
  EXPECT_EQ(a.j, 7);
  EXPECT_EQ(a.point_i, (Vec2<double>{1, 2}));
  EXPECT_EQ(a.point_j, (Vec2<double>{3, 4}));
  EXPECT_TRUE(a.has_axis);
  EXPECT_EQ(a.axis_i, (Vec2<double>{0.6, 0.8}));
}

TEST(Attachment, WithoutAnAxisTheJointsAxesAreThoseOfBodyI) {
  const ElementEntry<Revolute<>, double> entry{{{1, 2}, {3, 4}}, 0, 1};
  EXPECT_FALSE(attachment_of(entry).has_axis);
  EXPECT_EQ(attachment_of(entry).axis_i, (Vec2<double>{1, 0}));
}

}  // namespace
}  // namespace catena::testing
