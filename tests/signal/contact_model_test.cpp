#include "signal/contact_model.h"

#include <gtest/gtest.h>

#include <limits>

namespace fude {
namespace {

using Eigen::Vector3d;

Timestamp ms(int milliseconds) { return Timestamp(std::chrono::milliseconds(milliseconds)); }

// A quadratic energy of the offset: its negative gradient is the wrench, whatever the stiffness.
TEST(ContactModel, IsTheGradientOfItsEnergy) {
  ContactModel model;
  model.paper_from_handle = {Eigen::Quaterniond::Identity(), {10, 20, 30}};
  model.wrench = {{0.1, -0.2, 3}, {4, -5, 6}};
  Eigen::Matrix<double, 6, 6> root;
  for (int i = 0; i < 36; ++i) root(i / 6, i % 6) = ((i * 7) % 11 - 5) * 0.05;
  model.stiffness = root * root.transpose();
  model.valid_until = ms(5);

  const Vector3d shift(0.3, -0.1, 0.2), turn(0.01, 0.02, -0.015);
  Eigen::Matrix<double, 6, 1> offset;
  offset << shift, turn;
  const auto energy = [&](const Eigen::Matrix<double, 6, 1>& o) {
    return 0.5 * o.dot(model.stiffness * o) - model.wrench.force_n.dot(o.head<3>()) -
           model.wrench.torque_nmm.dot(o.tail<3>());
  };
  const Pose<Paper, Handle> pose{Eigen::Quaterniond(Eigen::AngleAxisd(turn.norm(), turn.normalized())),
                                 Vector3d(10, 20, 30) + shift};
  const auto wrench = felt(model, pose, ms(5));
  ASSERT_TRUE(wrench);
  for (int i = 0; i < 6; ++i) {
    Eigen::Matrix<double, 6, 1> step = Eigen::Matrix<double, 6, 1>::Zero();
    step[i] = 1e-4;
    const double slope = (energy(offset + step) - energy(offset - step)) / 2e-4;
    EXPECT_NEAR(i < 3 ? wrench->force_n[i] : wrench->torque_nmm[i - 3], -slope, 1e-5);
  }
}

TEST(ContactModel, ATurnIsMeasuredTheShortWayRound) {
  ContactModel model;
  model.wrench.force_n = {0, 0, 1};
  model.stiffness.bottomRightCorner<3, 3>().setIdentity();
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.1, Vector3d::UnitX()));
  const Eigen::Quaterniond same(-turn.w(), -turn.x(), -turn.y(), -turn.z());
  for (const auto& rotation : {turn, same})
    EXPECT_NEAR(felt(model, {rotation, Vector3d::Zero()}, {})->torque_nmm.x(), -0.1, 1e-4);
}

TEST(ContactModel, IsNothingAfterItsTime) {
  ContactModel model;
  model.wrench.force_n = {0, 0, 1};
  model.valid_until = ms(5);
  EXPECT_TRUE(felt(model, {}, ms(5)));
  EXPECT_FALSE(felt(model, {}, ms(5) + Duration(1)));
}

TEST(ContactModel, PaperNeverPulls) {
  ContactModel model;
  model.stiffness(2, 2) = 0.5;
  const auto force_at = [&](double height) {
    return felt(model, {Eigen::Quaterniond::Identity(), {0, 0, height}}, {})->force_n;
  };
  EXPECT_NEAR(force_at(-2).z(), 1, 1e-12);
  EXPECT_EQ(force_at(0), Vector3d::Zero());
  EXPECT_EQ(force_at(2), Vector3d::Zero());
  model.wrench.force_n = {5, 0, 1};  // dragged sideways, and lifted off
  EXPECT_EQ(force_at(10), Vector3d::Zero());
}

TEST(ContactModel, WhatIsNoNumberIsNotFelt) {
  ContactModel model;
  model.wrench.force_n = {0, 0, std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(felt(model, {}, {})->force_n, Vector3d::Zero());
}

}  // namespace
}  // namespace fude
