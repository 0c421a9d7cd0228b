// shapeid.h against the identifier that it stands for, and what it refuses.
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "shapeid/fast/identifier.hpp"
#include "shapeid/fast/shapeid.h"
#include "shapeid/models/robot_yaml.hpp"
#include "shapeid/models/version.hpp"
#include "shapeid/tests/fast/allocations.hpp"
#include "shapeid/tests/fast/cases.hpp"
#include "shapeid/tests/support/files.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"
#include "shapeid/tests/support/trot.hpp"

namespace shapeid {
namespace {

using fast::Identifier;
using Handle = std::unique_ptr<shapeid_identifier, decltype(&shapeid_destroy)>;

shapeid_settings defaults() {
  shapeid_settings settings;
  shapeid_default_settings(&settings);
  return settings;
}

Handle bundled_with(const shapeid_settings* settings,
                    const std::string& notes = test::bundled_file("robot.yaml")) {
  std::array<char, 200> error{};
  Handle made(shapeid_create(test::bundled_file("urdf").c_str(), notes.c_str(),
                             test::bundled_file("shapes.yaml").c_str(), settings, error.data(),
                             error.size()),
              &shapeid_destroy);
  EXPECT_NE(made, nullptr) << error.data();
  return made;
}

Handle bundled(const shapeid_settings& settings) { return bundled_with(&settings); }

/// A sample as C has it; valid as long as both arguments.
shapeid_sample plain(const Sample& s, std::vector<unsigned char>& flags) {
  flags.assign(s.in_contact.begin(), s.in_contact.end());
  shapeid_sample sample{};
  sample.time = s.time;
  for (int k = 0; k < 3; ++k) {
    sample.base_angular_velocity[k] = s.base_angular_velocity[k];
    sample.base_angular_acceleration[k] = s.base_angular_acceleration[k];
    sample.base_specific_force[k] = s.base_specific_force[k];
  }
  sample.joint_count = static_cast<size_t>(s.q.size());
  sample.q = s.q.data();
  sample.dq = s.dq.data();
  sample.ddq = s.ddq.data();
  sample.tau = s.tau.data();
  sample.contact_count = flags.size();
  sample.in_contact = flags.data();
  if (!s.contact_force.empty()) sample.contact_force = s.contact_force.front().data();
  return sample;
}

shapeid_status status_of(Identifier::Fed fed) {
  switch (fed) {
    case Identifier::Fed::kept:
      return SHAPEID_KEPT;
    case Identifier::Fed::answered:
      return SHAPEID_ANSWERED;
    case Identifier::Fed::sample_declined:
      return SHAPEID_SAMPLE_DECLINED;
    case Identifier::Fed::window_declined:
      return SHAPEID_WINDOW_DECLINED;
  }
  return SHAPEID_WRONG_ARGUMENT;
}

shapeid_stop stop_of(fast::Division::Stop stop) {
  switch (stop) {
    case fast::Division::Stop::limit:
      return SHAPEID_STOP_LIMIT;
    case fast::Division::Stop::step:
      return SHAPEID_STOP_STEP;
    case fast::Division::Stop::nothing_divisible:
      return SHAPEID_STOP_NOTHING_DIVISIBLE;
    case fast::Division::Stop::declined:
      break;
  }
  return SHAPEID_STOP_DECLINED;
}

std::vector<double> ten(const double* numbers) { return {numbers, numbers + 10}; }

/// The same code on the same numbers: equal to the bit.
void expect_same(const shapeid_identifier* c, const Identifier& identifier) {
  shapeid_answer answer;
  ASSERT_EQ(shapeid_get_answer(c, &answer), SHAPEID_ANSWERED);
  EXPECT_EQ(answer.time, identifier.answer().time);
  EXPECT_EQ(answer.objective, identifier.answer().value.total());
  EXPECT_EQ(answer.gap, identifier.answer().gap);
  EXPECT_EQ(answer.iterations, identifier.answer().iterations);
  EXPECT_EQ(answer.divisions, identifier.answer().divisions);
  EXPECT_EQ(answer.stopped_by, stop_of(identifier.answer().stopped_by));
  EXPECT_GE(answer.window_seconds, answer.last_call_seconds);
  EXPECT_GE(answer.window_seconds, answer.slowest_sample_seconds);
  EXPECT_EQ(ten(shapeid_parameters(c, 0)), ten(identifier.Phi().data()));
  EXPECT_EQ(ten(shapeid_filtered_parameters(c, 0)), ten(identifier.filtered().data()));
  const Eigen::VectorXd& m = identifier.undivided_masses();
  ASSERT_EQ(static_cast<Eigen::Index>(shapeid_shape_count(c)), m.size());
  EXPECT_EQ(Eigen::Map<const Eigen::VectorXd>(shapeid_masses(c), m.size()), m);
}

/// Feeds a noisy trot to both and compares whenever they answer.
void compare(const shapeid_settings& settings, const fast::IdentifierSettings& same,
             const std::vector<Sample>& samples, int fewest_answers) {
  const Robot robot = test::bundled_quadruped();
  const Handle c = bundled(settings);
  ASSERT_NE(c, nullptr);
  Identifier identifier(robot, test::bundled_shapes(robot), same);
  std::vector<unsigned char> flags;
  int answers = 0;
  for (const Sample& s : samples) {
    const shapeid_sample sample = plain(s, flags);
    const shapeid_status status = shapeid_feed(c.get(), &sample);
    ASSERT_EQ(status, status_of(identifier.feed(s)));
    if (status != SHAPEID_ANSWERED) continue;
    ++answers;
    ASSERT_NO_FATAL_FAILURE(expect_same(c.get(), identifier));
  }
  EXPECT_GE(answers, fewest_answers);
}

std::vector<Sample> trot_of(std::size_t count) {
  const Robot robot = test::bundled_quadruped();
  return test::trot(robot, stacked_parameters(robot), 3, count, test::Noise::sensors);
}

TEST(CInterface, DefaultsAreThoseOfTheIdentifier) {
  fast::IdentifierSettings same;
  same.expected_mass = 6.0;  // the middle of the range in quadruped.robot.yaml
  compare(defaults(), same, trot_of(200), 5);
}

/// What a rotor of robot.yaml takes is taken off what is fed: I gear^2 ddq, of that joint alone.
TEST(CInterface, RotorsAreTakenOffTheTorque) {
  const test::ScratchFolder scratch;
  const std::string text = test::text_of(test::bundled_file("robot.yaml"));
  const std::string path = scratch.write(
      "robot.yaml", text + "\nrotors: {FL_hip: {inertia: 0.0001220703125, gear: 8}}\n");
  const shapeid_settings settings = defaults();
  const Handle c = bundled_with(&settings, path);
  const Robot robot = test::bundled_quadruped();
  fast::IdentifierSettings same;
  same.expected_mass = 6.0;  // as above
  Identifier identifier(robot, test::bundled_shapes(robot), same);
  const int joint = robot.find_joint("FL_hip").value();
  std::vector<unsigned char> flags;
  int answers = 0;
  for (const Sample& s : trot_of(60)) {
    const shapeid_sample sample = plain(s, flags);
    Sample on_the_links = s;
    on_the_links.tau[joint] -= 0.0078125 * s.ddq[joint];
    const shapeid_status status = shapeid_feed(c.get(), &sample);
    ASSERT_EQ(status, status_of(identifier.feed(on_the_links)));
    if (status != SHAPEID_ANSWERED) continue;
    ++answers;
    ASSERT_NO_FATAL_FAILURE(expect_same(c.get(), identifier));
  }
  EXPECT_GT(answers, 1);
}

/// The bundled IMU is turned and off the base's origin.
TEST(CInterface, BaseQuantitiesAreMadeOfTheImus) {
  const Handle c = bundled(defaults());
  Robot robot = test::bundled_quadruped();
  const Eigen::Isometry3d imu = read_robot_yaml(test::bundled_file("robot.yaml"), robot).imu;
  ASSERT_GT(imu.translation().norm(), 0.0);
  const Eigen::Vector3d gyro(0.3, -0.7, 1.1), derivative(5.0, -2.0, 3.0), accel(1.0, 9.0, -2.0);
  shapeid_sample sample{};
  shapeid_set_base(c.get(), gyro.data(), derivative.data(), accel.data(), &sample);
  const Eigen::Matrix3d R = imu.linear();
  const Eigen::Vector3d r = imu.translation(), omega = R * gyro, alpha = R * derivative;
  const Eigen::Vector3d at_base = R * accel - alpha.cross(r) - omega.cross(omega.cross(r));
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(sample.base_angular_velocity[k], omega[k], 1e-15);
    EXPECT_NEAR(sample.base_angular_acceleration[k], alpha[k], 1e-14);
    EXPECT_NEAR(sample.base_specific_force[k], at_base[k], 1e-14);
  }
}

TEST(CInterface, SamplesAreForgottenAcrossAGap) {
  const Handle c = bundled(defaults());
  std::vector<unsigned char> flags;
  const std::vector<Sample> samples = trot_of(19);
  for (std::size_t k = 0; k < 19; ++k) {
    if (k == 9) shapeid_forget_samples(c.get());
    const shapeid_sample sample = plain(samples[k], flags);
    EXPECT_EQ(shapeid_feed(c.get(), &sample), k == 18 ? SHAPEID_ANSWERED : SHAPEID_KEPT) << k;
  }
}

TEST(CInterface, NoSettingsAreTheDefaults) {
  const Handle without = bundled_with(nullptr), with = bundled(defaults());
  std::vector<unsigned char> flags;
  for (const Sample& s : trot_of(20)) {
    const shapeid_sample sample = plain(s, flags);
    ASSERT_EQ(shapeid_feed(without.get(), &sample), shapeid_feed(with.get(), &sample));
  }
  shapeid_answer answer;
  ASSERT_EQ(shapeid_get_answer(without.get(), &answer), SHAPEID_ANSWERED);
  EXPECT_EQ(ten(shapeid_filtered_parameters(without.get(), 0)),
            ten(shapeid_filtered_parameters(with.get(), 0)));
}

TEST(CInterface, PassesEverySetting) {
  const Eigen::VectorXd weight = Eigen::VectorXd::LinSpaced(18, 1.0, 40.0);
  shapeid_settings settings = defaults();
  settings.weight = weight.data();
  settings.weight_count = 18;
  settings.window = 12;
  settings.stride = 8;
  settings.alpha = 0.3;
  settings.expected_mass = 5.0;
  settings.lambda = 1e-6;
  settings.mass_bound = 20.0;
  settings.most_divisions = 6;
  settings.division_step = 0.01;
  settings.division_patience = 2;
  fast::IdentifierSettings same;
  same.weight = weight;
  same.window = 12;
  same.stride = 8;
  same.alpha = 0.3;
  same.expected_mass = 5.0;
  same.lambda = 1e-6;
  same.mass_bound = 20.0;
  same.division.most_divisions = 6;
  same.division.step = 0.01;
  same.division.patience = 2;
  compare(settings, same, trot_of(200), 5);
}

TEST(CInterface, SaysWhatEndedTheDivisions) {
  const auto ending = [](const shapeid_settings& settings, const std::vector<Sample>& samples) {
    const Handle c = bundled(settings);
    std::vector<unsigned char> flags;
    for (const Sample& s : samples) {
      const shapeid_sample sample = plain(s, flags);
      shapeid_feed(c.get(), &sample);
    }
    shapeid_answer answer;
    EXPECT_EQ(shapeid_get_answer(c.get(), &answer), SHAPEID_ANSWERED);
    return std::pair(answer.stopped_by, answer.divisions);
  };
  shapeid_settings settings = defaults();
  EXPECT_EQ(ending(settings, trot_of(10)), std::pair(SHAPEID_STOP_LIMIT, 0));
  settings.most_divisions = 4;
  settings.division_step = 0.0;  // no step is below it
  EXPECT_EQ(ending(settings, trot_of(10)), std::pair(SHAPEID_STOP_LIMIT, 4));
  settings.division_step = 1e9;  // every step is
  settings.division_patience = 2;
  EXPECT_EQ(ending(settings, trot_of(10)), std::pair(SHAPEID_STOP_STEP, 2));
  // Nothing pulls, so no shape has mass.
  const std::vector<Sample> still(10, test::nothing_moves(test::bundled_quadruped()));
  settings.lambda = 1e-6;
  EXPECT_EQ(ending(settings, still), std::pair(SHAPEID_STOP_NOTHING_DIVISIBLE, 0));
}

TEST(CInterface, SaysWhyAWindowIsDeclined) {
  const Handle c = bundled(defaults());
  std::vector<unsigned char> flags;
  EXPECT_EQ(shapeid_last_outcome(nullptr), SHAPEID_OUTCOME_NONE);
  EXPECT_EQ(shapeid_last_outcome(c.get()), SHAPEID_OUTCOME_NONE);
  const auto last_status = [&](double factor) {
    shapeid_status status = SHAPEID_WRONG_ARGUMENT;
    for (Sample s : trot_of(10)) {
      s.tau *= factor;
      const shapeid_sample sample = plain(s, flags);
      status = shapeid_feed(c.get(), &sample);
    }
    return status;
  };
  // A first window beyond a hundred times all weight is none of this robot's.
  EXPECT_EQ(last_status(1e5), SHAPEID_WINDOW_DECLINED);
  EXPECT_EQ(shapeid_last_outcome(c.get()), SHAPEID_OUTCOME_OUT_OF_SCALE);
  Sample unknown = trot_of(1).front();
  unknown.time = std::numeric_limits<double>::quiet_NaN();
  const shapeid_sample declined = plain(unknown, flags);
  EXPECT_EQ(shapeid_feed(c.get(), &declined), SHAPEID_SAMPLE_DECLINED);
  EXPECT_EQ(shapeid_last_outcome(c.get()), SHAPEID_OUTCOME_OUT_OF_SCALE);
  EXPECT_EQ(last_status(1.0), SHAPEID_ANSWERED);
  EXPECT_EQ(shapeid_last_outcome(c.get()), SHAPEID_OUTCOME_SOLVED);
}

TEST(CInterface, PassesMeasuredForces) {
  shapeid_settings settings = defaults();
  settings.contacts = SHAPEID_MEASURED_CONTACTS;
  fast::IdentifierSettings same;
  same.contacts = ContactTreatment::measured;
  same.expected_mass = 6.0;
  std::vector<Sample> samples = trot_of(60);
  for (std::size_t k = 1; k < samples.size(); ++k) {  // the first has none and is declined
    for (std::size_t c = 0; c < 4; ++c) {
      samples[k].contact_force.emplace_back(0.1 * static_cast<double>(c), -1.0,
                                            samples[k].in_contact[c] ? 60.0 : 0.0);
    }
  }
  compare(settings, same, samples, 3);
}

TEST(CInterface, IgnoresContactsIfTold) {
  shapeid_settings settings = defaults();
  settings.contacts = SHAPEID_IGNORE_CONTACTS;
  fast::IdentifierSettings same;
  same.contacts = ContactTreatment::ignore;
  same.expected_mass = 6.0;
  compare(settings, same, trot_of(60), 3);
}

TEST(CInterface, NoFlagsAreNoContacts) {
  const Handle with = bundled(defaults()), without = bundled(defaults());
  std::vector<unsigned char> flags;
  for (Sample s : trot_of(20)) {
    s.in_contact.assign(s.in_contact.size(), false);
    shapeid_sample sample = plain(s, flags);
    const shapeid_status status = shapeid_feed(with.get(), &sample);
    sample.in_contact = nullptr;
    ASSERT_EQ(shapeid_feed(without.get(), &sample), status);
  }
  shapeid_answer one, other;
  ASSERT_EQ(shapeid_get_answer(with.get(), &one), SHAPEID_ANSWERED);
  ASSERT_EQ(shapeid_get_answer(without.get(), &other), SHAPEID_ANSWERED);
  EXPECT_GT(one.objective, 0.0);  // nobody says what carries the robot
  EXPECT_EQ(other.objective, one.objective);
}

TEST(CInterface, CountsAndNames) {
  const Handle c = bundled(defaults());
  const Robot robot = test::bundled_quadruped();
  ASSERT_EQ(shapeid_joint_count(c.get()), 12U);
  for (int j = 0; j < 12; ++j) {
    EXPECT_EQ(shapeid_joint_name(c.get(), static_cast<size_t>(j)), robot.joint(j).name);
  }
  ASSERT_EQ(shapeid_contact_count(c.get()), 4U);
  EXPECT_STREQ(shapeid_contact_name(c.get(), 2), "RR_foot");
  ASSERT_EQ(shapeid_free_link_count(c.get()), 1U);
  EXPECT_STREQ(shapeid_free_link_name(c.get(), 0), "base");
  EXPECT_EQ(shapeid_shape_count(c.get()), 11U);
  EXPECT_STREQ(shapeid_version(), version);
}

TEST(CInterface, NothingButPlacesThatExist) {
  const Handle c = bundled(defaults());
  EXPECT_EQ(shapeid_joint_name(c.get(), 12), nullptr);
  EXPECT_EQ(shapeid_contact_name(c.get(), 4), nullptr);
  EXPECT_EQ(shapeid_free_link_name(c.get(), 1), nullptr);
  EXPECT_EQ(shapeid_parameters(c.get(), 1), nullptr);
  EXPECT_EQ(shapeid_filtered_parameters(c.get(), 1), nullptr);
  // What C makes of -1, and of what ten times is too large to count.
  for (const size_t far : {SIZE_MAX, SIZE_MAX / 10 + 1, SIZE_MAX / 2 + 1}) {
    EXPECT_EQ(shapeid_parameters(c.get(), far), nullptr);
    EXPECT_EQ(shapeid_filtered_parameters(c.get(), far), nullptr);
    EXPECT_EQ(shapeid_free_link_name(c.get(), far), nullptr);
  }
  EXPECT_EQ(ten(shapeid_parameters(c.get(), 0)), std::vector<double>(10, 0.0));
  shapeid_answer answer;
  EXPECT_EQ(shapeid_get_answer(c.get(), &answer), SHAPEID_KEPT);
}

TEST(CInterface, NullIsAnswered) {
  const Handle c = bundled(defaults());
  shapeid_sample sample{};
  shapeid_answer answer;
  const double zero[3] = {};
  shapeid_default_settings(nullptr);
  shapeid_destroy(nullptr);
  shapeid_forget_samples(nullptr);
  shapeid_set_base(nullptr, zero, zero, zero, &sample);
  shapeid_set_base(c.get(), nullptr, zero, zero, &sample);
  shapeid_set_base(c.get(), zero, nullptr, zero, &sample);
  shapeid_set_base(c.get(), zero, zero, nullptr, &sample);
  shapeid_set_base(c.get(), zero, zero, zero, nullptr);
  EXPECT_EQ(shapeid_feed(nullptr, &sample), SHAPEID_WRONG_ARGUMENT);
  EXPECT_EQ(shapeid_feed(c.get(), nullptr), SHAPEID_WRONG_ARGUMENT);
  EXPECT_EQ(shapeid_get_answer(nullptr, &answer), SHAPEID_WRONG_ARGUMENT);
  EXPECT_EQ(shapeid_get_answer(c.get(), nullptr), SHAPEID_WRONG_ARGUMENT);
  EXPECT_EQ(shapeid_joint_count(nullptr), 0U);
  EXPECT_EQ(shapeid_contact_count(nullptr), 0U);
  EXPECT_EQ(shapeid_free_link_count(nullptr), 0U);
  EXPECT_EQ(shapeid_shape_count(nullptr), 0U);
  EXPECT_EQ(shapeid_joint_name(nullptr, 0), nullptr);
  EXPECT_EQ(shapeid_contact_name(nullptr, 0), nullptr);
  EXPECT_EQ(shapeid_free_link_name(nullptr, 0), nullptr);
  EXPECT_EQ(shapeid_parameters(nullptr, 0), nullptr);
  EXPECT_EQ(shapeid_filtered_parameters(nullptr, 0), nullptr);
  EXPECT_EQ(shapeid_masses(nullptr), nullptr);
}

// Samples that do not fit, between others, leave no trace.
TEST(CInterface, SamplesOfAnotherRobotAreRefused) {
  const Handle clean = bundled(defaults()), disturbed = bundled(defaults());
  const auto refused = [&](shapeid_sample sample, auto change) {
    change(sample);
    EXPECT_EQ(shapeid_feed(disturbed.get(), &sample), SHAPEID_WRONG_ARGUMENT);
  };
  std::vector<unsigned char> flags;
  for (const Sample& s : trot_of(10)) {
    const shapeid_sample sample = plain(s, flags);
    refused(sample, [](auto& wrong) { wrong.joint_count = 11; });
    refused(sample, [](auto& wrong) { wrong.joint_count = 13; });
    refused(sample, [](auto& wrong) { wrong.contact_count = 3; });
    refused(sample, [](auto& wrong) { wrong.q = nullptr; });
    refused(sample, [](auto& wrong) { wrong.dq = nullptr; });
    refused(sample, [](auto& wrong) { wrong.ddq = nullptr; });
    refused(sample, [](auto& wrong) { wrong.tau = nullptr; });
    EXPECT_EQ(shapeid_feed(disturbed.get(), &sample), shapeid_feed(clean.get(), &sample));
  }
  EXPECT_EQ(ten(shapeid_parameters(disturbed.get(), 0)), ten(shapeid_parameters(clean.get(), 0)));
}

// A body without joints has nothing to point at.
TEST(CInterface, EmptyArraysMayBeNull) {
  const test::ScratchFolder scratch;
  const std::string urdf =
      scratch.write("body.urdf", R"(<robot name="body"><link name="base"><inertial><mass value="2"/>
<inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial>
<collision><geometry><box size="0.5 0.5 0.5"/></geometry></collision></link></robot>)");
  shapeid_settings settings = defaults();
  settings.expected_mass = 2.0;
  std::array<char, 200> error{};
  const Handle c(
      shapeid_create(urdf.c_str(), nullptr, nullptr, &settings, error.data(), error.size()),
      &shapeid_destroy);
  ASSERT_NE(c, nullptr) << error.data();
  EXPECT_EQ(shapeid_joint_count(c.get()), 0U);
  const shapeid_sample sample{};
  EXPECT_EQ(shapeid_feed(c.get(), &sample), SHAPEID_KEPT);
}

/// What shapeid_create() says, asked for something that cannot be made.
std::string complaint(const std::string& urdf, const char* shapes,
                      const shapeid_settings& settings) {
  std::array<char, 400> error{};
  const Handle made(
      shapeid_create(urdf.c_str(), nullptr, shapes, &settings, error.data(), error.size()),
      &shapeid_destroy);
  EXPECT_EQ(made, nullptr);
  return error.data();
}

bool is_one_line_with(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos && text.find('\n') == std::string::npos;
}

TEST(CInterface, SaysWhatIsWrongWithFiles) {
  const std::string urdf = test::bundled_file("urdf"), yaml = test::bundled_file("shapes.yaml");
  EXPECT_PRED2(is_one_line_with, complaint("nowhere.urdf", nullptr, defaults()), "nowhere.urdf");
  EXPECT_PRED2(is_one_line_with, complaint(yaml, nullptr, defaults()), "quadruped.shapes.yaml:");
  EXPECT_PRED2(is_one_line_with, complaint(urdf, urdf.c_str(), defaults()), "quadruped.urdf:");
  EXPECT_EQ(shapeid_create(nullptr, nullptr, nullptr, nullptr, nullptr, 0), nullptr);
  std::array<char, 6> little{'?', '?', '?', '?', '?', '?'};
  EXPECT_EQ(shapeid_create("nowhere.urdf", nullptr, nullptr, nullptr, little.data(), 5), nullptr);
  EXPECT_STREQ(little.data(), "nowh");
  EXPECT_EQ(little[5], '?');
  // An option of the command, or of C++, helps nobody here.
  const test::ScratchFolder scratch;
  const std::string odd =
      scratch.write("odd.urdf", R"(<robot name="odd"><link name="base"><inertial>
<mass value="-2"/><inertia ixx="0.1" ixy="0" ixz="0" iyy="0.1" iyz="0" izz="0.1"/></inertial></link></robot>)");
  EXPECT_PRED2(is_one_line_with, complaint(odd, nullptr, defaults()),
               "mass is negative (-2 kg); correct it, or leave it out");
}

TEST(CInterface, SaysWhatIsWrongWithSettings) {
  const auto complaint_after = [](auto change) {
    shapeid_settings settings = defaults();
    change(settings);
    return complaint(test::bundled_file("urdf"), nullptr, settings);
  };
  const double one = 1.0;
  EXPECT_PRED2(is_one_line_with, complaint_after([](auto& s) { s.window = 0; }), "window");
  EXPECT_PRED2(is_one_line_with, complaint_after([](auto& s) { s.alpha = 0.0; }), "alpha");
  EXPECT_PRED2(is_one_line_with, complaint_after([](auto& s) { s.expected_mass = -1.0; }), "mass");
  EXPECT_PRED2(is_one_line_with, complaint_after([](auto& s) { s.mass_bound = -1.0; }), "bound");
  EXPECT_PRED2(is_one_line_with, complaint_after([](auto& s) { s.division_patience = -1; }),
               "patience");
  EXPECT_PRED2(is_one_line_with, complaint_after([&](auto& s) { s.weight = &one; }), "weight");
  EXPECT_PRED2(is_one_line_with, complaint_after([](auto& s) { s.weight_count = 18; }), "weight");
  // None of these is read: there is one number only. The last two are negative counts in C.
  for (const size_t count :
       {size_t{1}, size_t{17}, size_t{19}, SIZE_MAX / 2, SIZE_MAX - 17, SIZE_MAX}) {
    EXPECT_PRED2(is_one_line_with, complaint_after([&](auto& s) {
                   s.weight = &one;
                   s.weight_count = count;
                 }),
                 "weight and weight_count");
  }
  EXPECT_PRED2(is_one_line_with, complaint_after([](auto& s) { s.root = SHAPEID_FIXED_ROOT; }),
               "which links");
  EXPECT_PRED2(is_one_line_with, complaint_after([](auto& s) {
                 s.contacts = static_cast<shapeid_contacts>(SHAPEID_IGNORE_CONTACTS + 1);
               }),
               "no such treatment");
  // No InputError, but no memory.
  EXPECT_PRED2(is_one_line_with, complaint_after([](auto& s) { s.window = SIZE_MAX; }), "");
}

TEST(CInterface, AllocatesNothingAfterCreation) {
  shapeid_settings settings = defaults();
  settings.stride = 3;
  settings.most_divisions = 5;
  settings.contacts = SHAPEID_MEASURED_CONTACTS;
  const Handle c = bundled(settings);
  std::vector<Sample> samples = trot_of(300);
  for (Sample& s : samples) s.contact_force.assign(4, Eigen::Vector3d(0.0, 0.0, 30.0));
  std::vector<unsigned char> flags(4);
  double sum = 0.0;
  EXPECT_EQ(test::allocations_during([&] {
              for (const Sample& s : samples) {
                shapeid_sample sample = plain(s, flags);
                shapeid_answer answer;
                shapeid_set_base(c.get(), s.base_angular_velocity.data(),
                                 s.base_angular_acceleration.data(), s.base_specific_force.data(),
                                 &sample);
                if (shapeid_feed(c.get(), &sample) != SHAPEID_ANSWERED) continue;
                shapeid_get_answer(c.get(), &answer);
                sum += answer.objective + *shapeid_parameters(c.get(), 0) +
                       *shapeid_filtered_parameters(c.get(), 0) + *shapeid_masses(c.get());
              }
            }),
            0U);
  EXPECT_GT(sum, 0.0);
}

}  // namespace
}  // namespace shapeid
