// Foreign names, units, held columns, torque that is none; and what is wrong with a mapping file.
#include <gtest/gtest.h>

#include <cmath>

#include "shapeid/models/channels.hpp"
#include "shapeid/models/error.hpp"
#include "shapeid/models/log.hpp"
#include "shapeid/tests/motion/example.hpp"
#include "shapeid/tests/motion/message_of.hpp"
#include "shapeid/tests/support/scratch_folder.hpp"

namespace shapeid {
namespace {

using test::chain;
using test::message_of;
using test::ScratchFolder;

std::vector<MeasuredRow> rows_of(MeasuredRows& rows) {
  std::vector<MeasuredRow> out;
  while (std::optional<MeasuredRow> row = rows.next()) out.push_back(std::move(*row));
  return out;
}

TEST(Mapping, NamesUnitsSignsAndOffsets) {
  const ScratchFolder scratch;
  const auto log = scratch.write("a.csv", "t_ms,angle,load,temp\n1000,90,2,30\n1002,180,4,31\n");
  const Mapping mapping = read_mapping_yaml(scratch.write("m.yaml", R"(
columns:
  time: {from: t_ms, scale: 0.001}
  q.j0: {from: angle, scale: 0.017453292519943295, sign: -1, offset: 0.5}
  tau.j0: load
torque: {kind: joint}
)"));
  MeasuredRows rows(log, chain(1, Root::fixed), mapping);
  EXPECT_EQ(rows.plan().extra, std::vector<std::string>{"temp"});
  const auto out = rows_of(rows);
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[0].time, 1.0);
  EXPECT_EQ(out[1].time, 1002 * 0.001);
  EXPECT_EQ(out[0].values[rows.plan().q], 0.5 - 90.0 * 0.017453292519943295);
  EXPECT_EQ(out[1].values[rows.plan().tau], 4.0);
}

TEST(Mapping, GearsAndCurrentsScaleTheTorque) {
  const ScratchFolder scratch;
  const auto log = scratch.write("a.csv", "time,q.j0,q.j1,i1_A,i2_A\n0,0,0,2,3\n");
  for (const char* kind : {"motor", "current"}) {
    const Mapping mapping = read_mapping_yaml(scratch.write(
        "m.yaml", std::string("columns: {tau.j0: i1_A, tau.j1: {from: i2_A, offset: 1}}\n"
                              "torque: {kind: ") +
                      kind + ", factor: {j0: 9.5, j1: -2}}\n"));
    MeasuredRows rows(log, chain(2, Root::fixed), mapping);
    const MeasuredRow row = rows_of(rows).at(0);
    EXPECT_EQ(row.values[rows.plan().tau], 19.0);
    EXPECT_EQ(row.values[rows.plan().tau + 1], -8.0);  // offset in ampere: (3 + 1) * -2
  }
}

// A name that nothing asks for is a slip of the pen, not an extra signal.
TEST(Mapping, MakesNothingThatTheRobotDoesNotKnow) {
  const ScratchFolder scratch;
  const auto log = scratch.write("a.csv", "time,q.j0,tau.j0,speed\n0,0,0,3\n");
  for (const std::string target : {"dq.j7", "velocity.j0", "force.foot.x", "base.gyrodot.x"}) {
    const Mapping mapping =
        read_mapping_yaml(scratch.write("m.yaml", "columns: {" + target + ": speed}\n"));
    const std::string said =
        message_of<InputError>([&] { MeasuredRows(log, chain(1, Root::fixed), mapping); }, log);
    EXPECT_EQ(said.find("m.yaml:1: " + target + " is made of column speed, and means nothing"), 0u)
        << said;
  }
  const Mapping right = read_mapping_yaml(scratch.write("m.yaml", "columns: {dq.j0: speed}\n"));
  EXPECT_GE(MeasuredRows(log, chain(1, Root::fixed), right).plan().dq, 0);
}

TEST(Mapping, JointsAreFoundByNameInTheRobotsOrder) {
  const ScratchFolder scratch;
  const auto log = scratch.write("a.csv", "tau.j1,q.j1,time,tau.j0,q.j0,q.gripper\n4,3,0,2,1,9\n");
  MeasuredRows rows(log, chain(2, Root::fixed), {});
  const MeasuredRow row = rows_of(rows).at(0);
  EXPECT_EQ(row.values, Eigen::Vector4d(1, 3, 2, 4));
  EXPECT_EQ(rows.plan().extra, std::vector<std::string>{"q.gripper"});
}

TEST(Mapping, RowsAreKeptByValue) {
  const ScratchFolder scratch;
  const auto log =
      scratch.write("a.csv", "time,q.j0,tau.j0,new\n0,1,1,1\n0,2,2,0\n1,3,3,1\n2,4,4,\n");
  const Mapping mapping = read_mapping_yaml(scratch.write("m.yaml", "keep_rows: {new: 1}\n"));
  MeasuredRows rows(log, chain(1, Root::fixed), mapping);
  const auto out = rows_of(rows);  // the repeated stamp of row 2 does not count
  ASSERT_EQ(out.size(), 2u);
  EXPECT_EQ(out[1].values[0], 3.0);
  EXPECT_EQ(rows.rows(), 4u);
  EXPECT_EQ(rows.filtered(), 2u);
}

// A value that happens to repeat is a new measurement when another of its group has changed.
TEST(Mapping, HeldColumnsCountWhereTheyOrTheirGroupChange) {
  const ScratchFolder scratch;
  const auto log = scratch.write(
      "a.csv", "time,a,b,c,d\n0,1,5,7,1\n1,1,5,7,2\n2,2,5,7,3\n3,2,6,7,4\n4,2,6,8,5\n");
  const Mapping mapping = read_mapping_yaml(scratch.write("m.yaml", R"(
columns:
  q.j0: {from: a, hold: encoders}
  q.j1: {from: b, hold: encoders}
  tau.j0: {from: c, hold: true}
  tau.j1: {from: d, hold: false}
)"));
  MeasuredRows rows(log, chain(2, Root::fixed), mapping);
  std::string fresh;
  for (const MeasuredRow& row : rows_of(rows)) {
    for (const double value : row.values) fresh += std::isnan(value) ? '-' : 'x';
    fresh += ' ';
  }
  EXPECT_EQ(fresh, "xxxx ---x xx-x xx-x --xx ");
}

TEST(Mapping, SaysWhatIsWrongWithBrokenFiles) {
  struct Broken {
    std::string text, message;
  };
  const Broken table[] = {
      {"columns: [", "m.yaml:1: not YAML: end of sequence flow not found; write YAML"},
      {"- a", "m.yaml:1: the mapping is not a map; write lines of key: value"},
      {"colums: {}", "m.yaml:1: the mapping has no key colums; it has columns, keep_rows, torque"},
      {"columns:\n  time: a\n  time: b\n",
       "m.yaml:3: time is named twice in columns; name it once"},
      {"columns:\n  time: {scale: 2}\n", "m.yaml:2: time does not give its from; it needs from"},
      {"columns:\n  time: {from: a, factor: 2}\n",
       "m.yaml:2: time has no key factor; it has from, scale, offset, sign, hold"},
      {"columns:\n  time: {from: a, scale: 1,5}\n",
       "m.yaml:2: time has no key 5; it has from, scale, offset, sign, hold"},
      {"columns:\n  time: {from: a, scale: nan}\n",
       "m.yaml:2: scale is not a finite number (\"nan\"); write a finite decimal number"},
      {"columns:\n  time: {from: a, scale: 2m}\n",
       "m.yaml:2: scale is not a number (\"2m\"); write a finite decimal number"},
      {"columns:\n  time: {from: a, scale: 0}\n",
       "m.yaml:2: scale is zero; leave the column out instead"},
      {"columns:\n  q: {from: a, sign: 2}\n",
       "m.yaml:2: sign is 2; write 1 or -1, and factors as scale"},
      {"columns:\n  q: {from: [a]}\n", "m.yaml:2: from is not a word; write one word"},
      {"columns:\n  q: {from: a, hold: no}\n",
       "m.yaml:2: hold is no; write true, false, or a name that columns which are read at once "
       "share"},
      {"columns:\n  q: {from: a, hold: False}\n",
       "m.yaml:2: hold is False; write true, false, or a name that columns which are read at once "
       "share"},
      {"columns:\n  q: {from: a, hold: 0}\n",
       "m.yaml:2: hold is 0; write true, false, or a name that columns which are read at once "
       "share"},
      {"keep_rows: {new: yes}\n",
       "m.yaml:1: new is not a number (\"yes\"); write a finite decimal number"},
      {"torque: {factor: {j0: 1}}\n", "m.yaml:1: torque does not give its kind; it needs kind"},
      {"torque: {kind: ampere}\n",
       "m.yaml:1: torque kind ampere is not known; write joint, motor or current"},
      {"torque: {kind: current}\n",
       "m.yaml:1: current torque has no factors; give a gear ratio (motor) or N m per A (current) "
       "for every joint"},
      {"torque: {kind: motor, factor: {j0: 2, j1: 0}}\n",
       "m.yaml:1: the factor of j1 is zero; a gear ratio (motor) or N m per A (current)"},
      {"torque: {kind: joint, factor: {j0: 2}}\n",
       "m.yaml:1: joint torque has factors; leave them out, or say what they are of: kind: "
       "motor or current"},
  };
  const ScratchFolder scratch;
  for (const Broken& broken : table) {
    const auto path = scratch.write("m.yaml", broken.text);
    EXPECT_EQ(message_of<InputError>([&] { static_cast<void>(read_mapping_yaml(path)); }, path),
              broken.message);
  }
  const auto none = scratch.path("none.yaml");
  EXPECT_EQ(message_of<InputError>([&] { static_cast<void>(read_mapping_yaml(none)); }, none),
            "none.yaml: no such file, or not a regular one; check the path");
}

/// Reads all rows of a log and says how it went.
std::string reception(const std::string& log, const Robot& robot, const std::string& mapping) {
  const ScratchFolder scratch;
  const auto path = scratch.write("x.csv", log);
  const auto read = [&] {
    std::optional<Mapping> map;
    if (!mapping.empty()) map = read_mapping_yaml(scratch.write("m.yaml", mapping));
    MeasuredRows rows(path, robot, map);
    rows_of(rows);
  };
  return message_of<InputError>(read, path);
}

TEST(Channels, SayWhatALogLacks) {
  struct Broken {
    std::string log, mapping, message;
  };
  const Broken table[] = {
      {"time,q.j0\n", "",
       "x.csv:1: has no column tau.j0; add it, or name its source in a mapping file"},
      {"t,q.j0,tau.j0\n", "",
       "x.csv:1: has no column time; add it, or name its source in a mapping file"},
      {"time,q.j0,tau.j0\n", "columns: {q.j0: angle}",
       "m.yaml:1: q.j0 is to be column angle, which x.csv does not have; name a column of the log"},
      {"time,q.j0,tau.j0\n", "keep_rows:\n  new: 1\n",
       "m.yaml:2: rows are kept by column new, which x.csv does not have; name a column of the "
       "log"},
      {"time,q.j0,tau.j0\n", "columns:\n  dq.j0: q.j0\n",
       "m.yaml:2: column q.j0 of x.csv is to be q.j0 and dq.j0; a column of its own for each, in "
       "the log or in the mapping"},
      {"time,a,tau.j0\n", "columns:\n  dq.j0: a\n  q.j0: a\n",
       "m.yaml:2: column a of x.csv is to be q.j0 and dq.j0; a column of its own for each, in the "
       "log or in the mapping"},
      {"time,q.j0,tau.j0,touch\n", "columns:\n  contact.l0: touch\n",
       "m.yaml:2, column contact.l0: is no contact of the robot; name links of the URDF, and "
       "declare them as contacts in robot.yaml"},
      {"time,q.j0,tau.j0,base.gyro.x\n", "",
       "x.csv:1: has base.gyro.* or base.accel.* columns, but the robot's root is fixed; read the "
       "robot with a floating "
       "root, or leave the base.* columns out"},
      {"time,q.j0,tau.j0,contact.foot\n", "",
       "x.csv:1, column contact.foot: the robot has no link foot; name links of the URDF, and "
       "declare them as contacts in robot.yaml"},
      {"time,q.j0,tau.j0,contact.l0\n", "",
       "x.csv:1, column contact.l0: is no contact of the robot; name links of the URDF, and "
       "declare "
       "them as contacts in robot.yaml"},
      {"time,q.j0,i1_A\n", "columns: {tau.j0: i1_A}",
       "m.yaml:1: tau.j0 is to be column i1_A of x.csv, which sounds like a current or a "
       "motor-side torque; declare torque: {kind: joint | motor | current, factor} in the mapping"},
      {"time,q.j0,MotorTorque\n", "columns: {tau.j0: MotorTorque}",
       "m.yaml:1: tau.j0 is to be column MotorTorque of x.csv, which sounds like a current or a "
       "motor-side torque; declare torque: {kind: joint | motor | current, factor} in the mapping"},
      {"time,q.j0,i1_A\n", "columns: {tau.j0: i1_A}\ntorque: {kind: current, factor: {j9: 1}}",
       "m.yaml:2: there is no torque factor for joint j0; give N m per A of every joint"},
      {"time,q.j0,i1_A\n",
       "columns: {tau.j0: i1_A}\ntorque:\n  kind: current\n  factor:\n    j0: 1\n    j9: 1\n",
       "m.yaml:6: j9 has a torque factor, and is no joint that moves; name joints of chain that "
       "move"},
      {"time,q.j0,m\n", "columns: {tau.j0: m}\ntorque: {kind: motor, factor: {j9: 1}}",
       "m.yaml:2: there is no torque factor for joint j0; give the gear ratio of every joint"},
      {"time,q.j0,tau.j0\n0,1,1\n0,1,1\n", "",
       "x.csv:3, column time: the clock stands still at 0 s; give rows in increasing time, each "
       "time once"},
      {"time,q.j0,tau.j0\n2,1,1\n1.5,1,1\n", "",
       "x.csv:3, column time: the clock runs back from 2 to 1.5 s; give rows in increasing time, "
       "each time once"},
      {"time,q.j0,tau.j0\n,1,1\n", "", "x.csv:2, column time: is empty; give every row its time"},
      {"time,q.j0,i1_A\n", "columns: {tau.j0: i1_A}\ntorque: {kind: joint}", "accepted"},
  };
  for (const Broken& broken : table) {
    EXPECT_EQ(reception(broken.log, chain(1, Root::fixed), broken.mapping), broken.message);
  }
  EXPECT_EQ(reception("time,q.j0,tau.j0\n", chain(1, Root::floating), ""),
            "x.csv:1: has no base.gyro.* and base.accel.* columns, but the robot's root floats; "
            "read the robot with a "
            "fixed root, or log base.gyro.{x,y,z} and base.accel.{x,y,z}");
  EXPECT_EQ(reception("time,q.j0,tau.j0,base.gyro.x,base.gyro.y,base.gyro.z\n",
                      chain(1, Root::floating), ""),
            "x.csv:1: has no column base.accel.x; add it, or name its source in a mapping file");
  EXPECT_EQ(reception("time,q.j0,q.j1,dq.j0,tau.j0,tau.j1\n", chain(2, Root::fixed), ""),
            "x.csv:1: has no column dq.j1; add it, or name its source in a mapping file");
  Robot foot = chain(1, Root::fixed);
  foot.contacts.push_back({"l0", 1, ContactKind::point, Eigen::Isometry3d::Identity()});
  EXPECT_EQ(reception("time,q.j0,tau.j0,contact.l0\n0,1,1,0.5\n", foot, ""),
            "x.csv:2, column contact.l0: 0.5 is no flag; write 1 for touching, 0 for not, -1 or "
            "nothing for not known");
}

TEST(Mapping, FlagsMayBeTurnedRound) {
  Robot foot = chain(1, Root::fixed);
  foot.contacts.push_back({"l0", 1, ContactKind::point, Eigen::Isometry3d::Identity()});
  const ScratchFolder scratch;
  const auto log = scratch.write("a.csv", "time,q.j0,tau.j0,in_air\n0,1,1,1\n1,1,1,0\n2,1,1,\n");
  const Mapping mapping = read_mapping_yaml(
      scratch.write("m.yaml", "columns:\n  contact.l0: {from: in_air, scale: -1, offset: 1}\n"));
  MeasuredRows rows(log, foot, mapping);
  std::vector<int> flags;
  for (const MeasuredRow& row : rows_of(rows)) flags.push_back(row.contacts.at(0));
  EXPECT_EQ(flags, (std::vector<int>{0, 1, -1}));
}

TEST(DefaultContacts, SitAtTheOriginOfTheNamedLinkAlsoWhenLumped) {
  Robot robot = chain(2, Root::floating);
  Member foot;
  foot.name = "foot";
  foot.pose.translation() = Eigen::Vector3d(0.1, -0.2, -0.3);
  robot.links[2].members.push_back(foot);
  const ScratchFolder scratch;
  const auto log = scratch.write("a.csv", "time,contact.l0,touch\n");
  const Mapping mapping =
      read_mapping_yaml(scratch.write("m.yaml", "columns: {contact.foot: touch}"));
  add_default_contacts(robot, log, mapping);
  ASSERT_EQ(robot.contacts.size(), 2u);
  EXPECT_EQ(robot.contacts[0].name, "foot");
  EXPECT_EQ(robot.contacts[0].link, 2);
  EXPECT_EQ(robot.contacts[0].frame.translation(), foot.pose.translation());
  EXPECT_EQ(robot.contacts[1].name, "l0");
  EXPECT_EQ(robot.contacts[1].link, 1);
  add_default_contacts(robot, log, mapping);
  EXPECT_EQ(robot.contacts.size(), 2u);
  Robot other = chain(2, Root::floating);
  EXPECT_THROW(add_default_contacts(other, log, mapping), InputError);
}

}  // namespace
}  // namespace shapeid
