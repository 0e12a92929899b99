#include "rig/arm_on_paper.h"

#include <gtest/gtest.h>

namespace fude {
namespace {

using Eigen::Vector3d;

HapticSample grip(const Vector3d& position_m, const Vector3d& velocity_mps = Vector3d::Zero()) {
  HapticSample sample;
  sample.position_m = position_m;
  sample.velocity_mps = velocity_mps;
  sample.homed = true;
  return sample;
}

TEST(ArmOnPaper, TheArmsAxesAreThePaintersOwn) {
  const ArmPlace place{{100, 50, 20}};
  const auto at = [&](const Vector3d& p) { return paper_from_grip(grip(p), place).translation; };
  EXPECT_EQ(at({0, 0, 0}), Vector3d(100, 50, 20));
  EXPECT_EQ(at({0.01, 0, 0}), Vector3d(110, 50, 20));  // right
  EXPECT_EQ(at({0, 0.01, 0}), Vector3d(100, 50, 30));  // up
  EXPECT_EQ(at({0, 0, 0.01}), Vector3d(100, 40, 20));  // to the painter
}

TEST(ArmOnPaper, ThePlanePushesUpByItsDepthAlone) {
  Newest<ContactModel> models;
  const auto feel = feel_of(models, {{0, 0, 20}});
  models.put(paper_plane(15, Timestamp::max()));
  EXPECT_EQ(feel(grip({0, 0, 0})), Vector3d::Zero());
  EXPECT_EQ(feel(grip({0.02, -0.0049, 0.01})), Vector3d::Zero());
  const auto pushed = feel(grip({0.02, -0.007, 0.01}));
  ASSERT_TRUE(pushed);
  EXPECT_NEAR(pushed->y(), 2 * paper_stiffness_n_per_mm, 1e-9);
  EXPECT_NEAR(pushed->x(), 0, 1e-12);
  EXPECT_NEAR(pushed->z(), 0, 1e-12);
}

TEST(ArmOnPaper, DampingStopsAHandAndNeverPullsIt) {
  Newest<ContactModel> models;
  const auto feel = feel_of(models, {});
  models.put(paper_plane(0, Timestamp::max()));
  const double still = feel(grip({0, -0.001, 0}))->y();
  EXPECT_NEAR(feel(grip({0, -0.001, 0}, {0, -0.1, 0}))->y() - still, 0.1 * paper_damping_ns_per_m, 1e-9);
  EXPECT_EQ(feel(grip({0, -0.001, 0}, {0, 10, 0})), Vector3d::Zero());
  EXPECT_EQ(feel(grip({0, 0.001, 0}, {0, -10, 0})), Vector3d::Zero());  // above the paper
}

TEST(ArmOnPaper, AModelOfYesterdayIsNoCommand) {
  Newest<ContactModel> models;
  const auto feel = feel_of(models, {});
  const auto at = [](int ms) { return Timestamp(std::chrono::milliseconds(ms)); };
  auto sample = grip({0, -0.001, 0});
  sample.time.host = at(10);
  EXPECT_FALSE(feel(sample));  // none yet
  models.put(paper_plane(0, at(10)));
  EXPECT_TRUE(feel(sample));
  sample.time.host = at(11);
  EXPECT_FALSE(feel(sample));
  models.put(paper_plane(0, at(20)));
  EXPECT_TRUE(feel(sample));
}

}  // namespace
}  // namespace fude
