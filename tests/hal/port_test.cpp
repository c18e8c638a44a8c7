#include "hal/port.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>
#include <rapidcheck.h>

#include "hal/device/body_sensors.hpp"
#include "hal/device/cameras.hpp"
#include "hal/device/distance_scanner.hpp"
#include "hal/device/gripper.hpp"
#include "hal/device/leds.hpp"
#include "hal/device/range_and_bearing.hpp"
#include "hal/device/ring_sensors.hpp"
#include "hal/device/turret.hpp"
#include "hal/device/wheels.hpp"
#include "hal/scalar_name.hpp"

namespace tandem::hal {
namespace {

using testing::HasSubstr;

/// A field of every scalar, and of every fusion.
struct Mixed : Reading {
  static constexpr std::string_view kName = "mixed";
  static constexpr std::string_view kDoc = "For tests.";
  float f32 = 1.5F;
  double f64 = -2.25;
  std::uint8_t u8 = 200;
  std::uint16_t u16 = 60000;
  std::uint32_t u32 = 4'000'000'000U;
  std::int32_t i32 = -5;
  std::int64_t i64 = -(1LL << 40);
  bool flag = true;
  std::uint32_t used = 2;
  std::array<float, 4> pair_of{0.1F, 0.2F, 0.3F, 0.4F};
  std::array<std::uint8_t, 8> bytes{1, 2, 3, 4, 5, 6, 7, 8};
  void describe(FieldList& f) const {
    f.add("f32", f32, unit::m, Frame::Body, Fusion::Nearer, "");
    f.add("f64", f64, unit::s, Frame::World, Fusion::Larger, "");
    f.add("u8", u8, unit::none, Frame::None, Fusion::Virtual, "");
    f.add("u16", u16, unit::none, Frame::None, Fusion::Real, "");
    f.add("u32", u32, unit::none, Frame::None, Fusion::Real, "");
    f.add("i32", i32, unit::none, Frame::None, Fusion::Real, "");
    f.add("i64", i64, unit::none, Frame::None, Fusion::Real, "");
    f.add("flag", flag, unit::none, Frame::None, Fusion::Larger, "");
    f.add("used", used, unit::none, Frame::None, Fusion::Real, "");
    f.add("pair_of", pair_of, unit::none, Frame::None, Fusion::Nearer, "").used_by = "used";
    f.add("bytes", bytes, unit::none, Frame::None, Fusion::Real, "").used_by = "used";
  }
};

/// The same name, another type of one field.
struct MixedLater : Reading {
  static constexpr std::string_view kName = "mixed";
  static constexpr std::string_view kDoc = "For tests.";
  double f32 = 0.0;
  void describe(FieldList& f) const { f.add("f32", f32, unit::m, Frame::Body, Fusion::Nearer, ""); }
};

double value(const Mixed& port, std::string_view name, std::size_t i = 0) {
  return get_value(&port, *port_type<Mixed>().field(name), i);
}

TEST(PortType, DescribesItsFields) {
  const PortType& type = port_type<Mixed>();
  EXPECT_EQ(type.name, "mixed");
  EXPECT_EQ(type.role, Role::Sensor);
  EXPECT_EQ(type.size, sizeof(Mixed));
  EXPECT_EQ(type.align, alignof(Mixed));
  EXPECT_EQ(type.fields.size(), 13U);
  EXPECT_EQ(type.fields[0].name, "taken_ns");
  EXPECT_EQ(type.fields[1].name, "validity");
  EXPECT_EQ(type.field("bytes")->scalar, Scalar::U8);
  EXPECT_EQ(type.field("bytes")->count, 8U);
  EXPECT_EQ(type.field("none"), nullptr);
  EXPECT_EQ(port_type<WheelSpeeds>().role, Role::Actuator);
  EXPECT_EQ(port_type<WheelSpeeds>().fields.size(), 2U) << "commands have no stamp";
}

TEST(PortType, LayoutsDifferWhenFieldsDo) {
  EXPECT_NE(port_type<Mixed>().layout, port_type<MixedLater>().layout);
  EXPECT_NE(port_type<Proximity>().layout, port_type<Light>().layout);
}

TEST(PortType, ResetWritesTheDefault) {
  WheelSpeeds command;
  command.set(1.0, -1.0);
  port_type<WheelSpeeds>().reset(&command);
  EXPECT_EQ(command.left_m_s, 0.0);
  Proximity reading;
  reading.validity = Validity::Fresh;
  port_type<Proximity>().reset(&reading);
  EXPECT_EQ(reading.validity, Validity::Absent);
}

TEST(Values, AreReadExactly) {
  const Mixed port;
  EXPECT_EQ(value(port, "f32"), 1.5);
  EXPECT_EQ(value(port, "f64"), -2.25);
  EXPECT_EQ(value(port, "u8"), 200.0);
  EXPECT_EQ(value(port, "u16"), 60000.0);
  EXPECT_EQ(value(port, "u32"), 4e9);
  EXPECT_EQ(value(port, "i32"), -5.0);
  EXPECT_EQ(value(port, "i64"), -std::pow(2.0, 40.0));
  EXPECT_EQ(value(port, "flag"), 1.0);
  EXPECT_EQ(value(port, "bytes", 7), 8.0);
}

TEST(Values, ComeBackAsTheyWereSet) {
  EXPECT_TRUE(rc::check([](std::int32_t any, std::uint8_t small) {
    Mixed port;
    const PortType& type = port_type<Mixed>();
    for (const char* name : {"f64", "i32", "i64"}) {
      set_value(&port, *type.field(name), 0, any);
      RC_ASSERT(value(port, name) == any);
    }
    for (const char* name : {"f32", "u8", "u16", "u32"}) {
      set_value(&port, *type.field(name), 0, small);
      RC_ASSERT(value(port, name) == small);
    }
    const std::size_t i = small % 8;
    set_value(&port, *type.field("bytes"), i, small);
    RC_ASSERT(port.bytes[i] == small);
    set_value(&port, *type.field("flag"), 0, any);
    RC_ASSERT(port.flag == (any != 0));
  }));
}

TEST(UsedCount, FollowsTheCountField) {
  Mixed port;
  const PortType& type = port_type<Mixed>();
  EXPECT_EQ(used_count(type, &port, *type.field("pair_of")), 2U);
  EXPECT_EQ(used_count(type, &port, *type.field("bytes")), 4U) << "two bytes an entry, as 8 is twice 4";
  EXPECT_EQ(used_count(type, &port, *type.field("f32")), 1U);
  port.used = 4'000'000'000U;
  EXPECT_EQ(used_count(type, &port, *type.field("pair_of")), 4U) << "never more than there is memory for";
  EXPECT_EQ(used_count(type, &port, *type.field("bytes")), 8U);
}

TEST(ToText, ShowsWhatIsInUse) {
  Mixed port;
  const std::string text = to_text(port_type<Mixed>(), &port);
  EXPECT_THAT(text, testing::StartsWith("mixed: taken_ns=0 validity=0 f32=1.5 m f64=-2.25 s u8=200"));
  EXPECT_THAT(text, HasSubstr("pair_of=[0.1 0.2]"));
  EXPECT_THAT(text, HasSubstr("bytes=[1 2 3 4]"));
}

TEST(MaxDifference, IsTheLargestOfAllFieldsInUse) {
  const PortType& type = port_type<Mixed>();
  Mixed a;
  Mixed b;
  EXPECT_EQ(max_difference(type, &a, &b), 0.0);
  b.taken_ns = 77;
  b.validity = Validity::Fresh;
  b.pair_of[3] = 9.0F;  // not in use
  EXPECT_EQ(max_difference(type, &a, &b), 0.0);
  b.f64 += 0.5;
  b.i32 += 3;
  EXPECT_EQ(max_difference(type, &a, &b), 3.0);
  b.used = 3;
  EXPECT_EQ(max_difference(type, &a, &b), std::numeric_limits<double>::infinity());
  b.used = 2;
  b.f32 = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(max_difference(type, &a, &b), std::numeric_limits<double>::infinity());
}

TEST(AllFinite, LooksAtFloatingPointAlone) {
  Mixed port;
  EXPECT_TRUE(all_finite(port_type<Mixed>(), &port));
  port.pair_of[3] = std::numeric_limits<float>::infinity();
  EXPECT_FALSE(all_finite(port_type<Mixed>(), &port));
  port.pair_of[3] = 0.0F;
  port.f64 = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(all_finite(port_type<Mixed>(), &port));
}

// --- fusion ---

Mixed fresh() {
  Mixed port;
  port.validity = Validity::Fresh;
  return port;
}

TEST(Fuse, TakesEachFieldAsItSays) {
  Mixed real = fresh();
  Mixed virt = fresh();
  real.taken_ns = 5;
  virt.taken_ns = 9;
  virt.f32 = 1.0F;
  virt.f64 = -9.0;
  virt.u8 = 7;
  virt.u16 = 1;
  real.flag = false;
  virt.pair_of = {0.5F, 0.05F, 0.0F, 0.0F};
  fuse(port_type<Mixed>(), &real, &virt);
  EXPECT_EQ(real.f32, 1.0F) << "the nearer";
  EXPECT_EQ(real.f64, -2.25) << "the larger";
  EXPECT_EQ(real.u8, 7) << "the virtual";
  EXPECT_EQ(real.u16, 60000) << "the real";
  EXPECT_TRUE(real.flag);
  EXPECT_EQ(real.pair_of[0], 0.1F);
  EXPECT_EQ(real.pair_of[1], 0.05F);
  EXPECT_EQ(real.taken_ns, 5) << "stamped as the real one";
}

TEST(Fuse, LeavesOutAnAbsentVirtualReading) {
  Mixed real = fresh();
  Mixed virt = fresh();
  virt.f32 = 0.0F;
  virt.validity = Validity::Absent;
  fuse(port_type<Mixed>(), &real, &virt);
  EXPECT_EQ(real.f32, 1.5F);
}

TEST(Fuse, KeepsAStaleRealReadingStale) {
  Mixed real = fresh();
  real.validity = Validity::Stale;
  const Mixed virt = fresh();
  fuse(port_type<Mixed>(), &real, &virt);
  EXPECT_EQ(real.validity, Validity::Stale);
}

TEST(Fuse, AnAbsentRealDeviceStaysAbsentUnlessTheVirtualOneMayStandIn) {
  Proximity real_eyes;
  Proximity virtual_eyes;
  virtual_eyes.validity = Validity::Fresh;
  virtual_eyes.count = 8;
  fuse(port_type<Proximity>(), &real_eyes, &virtual_eyes);
  EXPECT_EQ(real_eyes.validity, Validity::Absent);

  Ground real_ground;
  Ground virtual_ground;
  virtual_ground.validity = Validity::Fresh;
  virtual_ground.count = 3;
  virtual_ground.reflectance[1] = 0.5F;
  fuse(port_type<Ground>(), &real_ground, &virtual_ground);
  EXPECT_EQ(real_ground.validity, Validity::Fresh);
  EXPECT_EQ(real_ground.reflectance[1], 0.5F);
}

TEST(Fuse, TakesTheNearerOfTwoProximities) {
  Proximity real;
  Proximity virt;
  for (Proximity* p : {&real, &virt}) {
    p->validity = Validity::Fresh;
    p->count = 8;
    p->range_m = 0.1F;
    p->distance_m.fill(0.1F);
  }
  real.distance_m[0] = 0.02F;
  virt.distance_m[0] = 0.05F;
  virt.distance_m[3] = 0.01F;
  fuse(port_type<Proximity>(), &real, &virt);
  EXPECT_EQ(real.distance_m[0], 0.02F);
  EXPECT_EQ(real.distance_m[3], 0.01F);
  EXPECT_EQ(real.distance_m[5], 0.1F);
  EXPECT_FLOAT_EQ(real.closeness(3), 0.9F);
}

TEST(Fuse, NeverTouchesCommands) {
  WheelSpeeds real;
  WheelSpeeds virt;
  virt.set(1, 1);
  fuse(port_type<WheelSpeeds>(), &real, &virt);
  EXPECT_EQ(real.left_m_s, 0.0);
}

RangeAndBearing heard(std::initializer_list<float> ranges) {
  RangeAndBearing port;
  port.validity = Validity::Fresh;
  for (const float range : ranges) {
    const std::uint8_t byte = static_cast<std::uint8_t>(range);
    port.insert(range, 0.5F * range, 0.0F, &byte, 1);
  }
  return port;
}

TEST(RangeAndBearing, KeepsMessagesInOrderOfRange) {
  const RangeAndBearing port = heard({3, 1, 2});
  ASSERT_EQ(port.count, 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(port.range_m[i], static_cast<float>(i + 1));
    EXPECT_EQ(port.bearing_rad[i], 0.5F * static_cast<float>(i + 1));
    EXPECT_EQ(port.message(i)[0], i + 1);
  }
}

TEST(RangeAndBearing, DropsTheFarthestWhenFull) {
  RangeAndBearing port = heard({});
  const std::uint8_t byte = 0;
  for (int i = 30; i > 0; --i) port.insert(static_cast<float>(i), 0.0F, 0.0F, &byte, 1);
  EXPECT_EQ(port.count, RangeAndBearing::kCapacity);
  EXPECT_EQ(port.dropped, 30U - RangeAndBearing::kCapacity);
  EXPECT_EQ(port.range_m.front(), 1.0F);
  EXPECT_EQ(port.range_m.back(), 16.0F);
}

TEST(RangeAndBearing, SendsWhatItsPortHolds) {
  RobotKind kind;
  EXPECT_EQ(message_bytes(kind, kRabPayloadMax), 0U);
  kind.add(RangeAndBearingPart{.payload = 64});
  EXPECT_EQ(message_bytes(kind, kRabPayloadMax), kRabPayloadMax);
  EXPECT_EQ(message_bytes(kind, kLongRabPayloadMax), 64U);
}

TEST(RangeAndBearing, FusesToTheUnion) {
  RangeAndBearing real = heard({1, 4});
  const RangeAndBearing virt = heard({2, 3});
  fuse(port_type<RangeAndBearing>(), &real, &virt);
  ASSERT_EQ(real.count, 4U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(real.range_m[i], static_cast<float>(i + 1));
}

TEST(RangeAndBearing, ANearEqualMessageOfBothWorldsIsOne) {
  RangeAndBearing real = heard({1, 4});
  const std::uint8_t one = 1, two = 2;
  RangeAndBearing virt = heard({});
  virt.insert(1.02F, 0.51F, 0.0F, &one, 1);  // the same
  virt.insert(1.02F, 0.51F, 0.0F, &two, 1);  // other bytes
  virt.insert(1.02F, 0.61F, 0.0F, &one, 1);  // from elsewhere
  virt.insert(1.02F, 0.61F, 0.0F, &one, 1);  // two that are only in one world are two
  fuse(port_type<RangeAndBearing>(), &real, &virt);
  EXPECT_EQ(real.count, 5U);
}

TEST(RangeAndBearing, AnAbsentRealBoardHearsTheVirtualOne) {
  RangeAndBearing real;
  const RangeAndBearing virt = heard({2});
  fuse(port_type<RangeAndBearing>(), &real, &virt);
  EXPECT_EQ(real.count, 1U);
  EXPECT_EQ(real.validity, Validity::Fresh);
}

TEST(Cameras, ALightOfBothWorldsIsOneBlob) {
  OmnidirectionalCamera real;
  real.validity = Validity::Fresh;
  real.insert(0.5F, 0.3F, {200, 20, 10});
  OmnidirectionalCamera virt;
  virt.validity = Validity::Fresh;
  virt.insert(0.51F, 0.31F, kRed);   // the same
  virt.insert(0.51F, 0.31F, kBlue);  // of another colour
  virt.insert(0.55F, 0.31F, kRed);   // elsewhere
  fuse(port_type<OmnidirectionalCamera>(), &real, &virt);
  EXPECT_EQ(real.count, 3U);
  PerspectiveCamera seen;
  seen.validity = Validity::Fresh;
  seen.append(100.0F, 50.0F, kGreen);
  PerspectiveCamera virtually = seen;
  virtually.append(110.0F, 50.0F, kGreen);
  fuse(port_type<PerspectiveCamera>(), &seen, &virtually);
  EXPECT_EQ(seen.count, 2U);
}

DistanceScanner scan(std::uint32_t samples, float step_rad, float distance_m) {
  DistanceScanner port;
  port.validity = Validity::Fresh;
  port.samples = samples;
  port.count = samples * DistanceScanner::kHeads;
  port.short_min_m = 0.04F;
  port.short_max_m = 0.3F;
  port.long_min_m = 0.2F;
  port.long_max_m = 1.5F;
  for (std::size_t head = 0; head < DistanceScanner::kHeads; ++head) {
    for (std::size_t k = 0; k < samples; ++k) {
      const float angle = 1.5707963F * static_cast<float>(head) - step_rad * static_cast<float>(samples - 1 - k);
      port.angle_rad[port.at(head, k)] = std::remainder(angle, 6.2831853F);
      port.distance_m[port.at(head, k)] = distance_m;
    }
  }
  return port;
}

TEST(Scanner, AVirtualScannerThatMeasuredNothingChangesNothing) {
  DistanceScanner real = scan(1, 0.0F, 0.25F);
  DistanceScanner virt;
  virt.validity = Validity::Fresh;
  fuse(port_type<DistanceScanner>(), &real, &virt);
  for (std::size_t i = 0; i < real.count; ++i) EXPECT_EQ(real.distance_m[i], 0.25F) << i;
}

TEST(Scanner, TakesTheNearerOfWhatLooksTheSameWayHoweverOftenEachMeasured) {
  DistanceScanner real = scan(1, 0.0F, 0.25F);
  DistanceScanner virt = scan(6, 0.3F, 0.28F);
  virt.distance_m[virt.at(1, 5)] = 0.21F;  // as head 1 looks
  virt.distance_m[virt.at(2, 0)] = 0.05F;  // where none of the real heads looked
  fuse(port_type<DistanceScanner>(), &real, &virt);
  EXPECT_EQ(real.samples, 1U);
  EXPECT_EQ(real.distance_m[0], 0.25F);
  EXPECT_EQ(real.distance_m[1], 0.21F);
  EXPECT_EQ(real.distance_m[2], 0.25F);
  EXPECT_EQ(real.distance_m[3], 0.25F);
}

TEST(Scanner, AnAbsentOneIsNotMadeUp) {
  DistanceScanner real;
  const DistanceScanner virt = scan(1, 0.0F, 0.1F);
  fuse(port_type<DistanceScanner>(), &real, &virt);
  EXPECT_EQ(real.validity, Validity::Absent);
}

TEST(Fuse, FieldsInUseAreThoseOfBothAndTheVirtualFloorBringsItsOwnNumber) {
  Proximity near;
  near.validity = Validity::Fresh;
  near.count = 8;
  near.distance_m.fill(0.1F);
  Proximity virt;
  virt.validity = Validity::Fresh;
  virt.count = 3;  // the rest of its array is 0, which means nothing
  virt.distance_m.fill(0.0F);
  fuse(port_type<Proximity>(), &near, &virt);
  EXPECT_EQ(near.distance_m[2], 0.0F);
  EXPECT_EQ(near.distance_m[3], 0.1F);
  Ground floor;
  floor.validity = Validity::Fresh;
  Ground painted;
  painted.validity = Validity::Fresh;
  painted.count = 3;
  painted.reflectance = {0.5F, 0.6F, 0.7F};
  fuse(port_type<Ground>(), &floor, &painted);
  EXPECT_EQ(floor.count, 3U);
  EXPECT_EQ(floor.reflectance[2], 0.7F);
}

// --- every port of the control interface ---

template <class T>
class EveryPort : public testing::Test {};
using Ports =
    testing::Types<Proximity, Light, Ground, WheelEncoders, Accelerometer, Microphones, Battery, Clock, RangeAndBearing,
                   BaseGround, MotorGround, Odometry, Gyroscope, TurretEncoder, Gripper, DistanceScanner, WheelSpeeds,
                   RingLeds, BodyLed, FrontLed, RangeAndBearingSend, TurretDrive, GripperDrive, ScannerDrive>;
TYPED_TEST_SUITE(EveryPort, Ports);

TYPED_TEST(EveryPort, IsDocumentedAndLiesWithinItsMemory) {
  const PortType& type = port_type<TypeParam>();
  EXPECT_FALSE(type.name.empty());
  EXPECT_FALSE(type.doc.empty());
  std::vector<bool> taken(type.size, false);
  for (const Field& f : type.fields) {
    EXPECT_FALSE(f.name.empty());
    EXPECT_FALSE(f.doc.empty()) << f.name;
    EXPECT_EQ(type.field(f.name), &f) << "names are unique";
    EXPECT_TRUE(f.used_by.empty() || type.field(f.used_by) != nullptr) << f.name;
    const std::size_t width = f.scalar == Scalar::U8 || f.scalar == Scalar::Bool   ? 1
                              : f.scalar == Scalar::U16                            ? 2
                              : f.scalar == Scalar::F64 || f.scalar == Scalar::I64 ? 8
                                                                                   : 4;
    ASSERT_LE(f.offset + f.count * width, type.size) << f.name;
    for (std::size_t i = 0; i < f.count * width; ++i) {
      EXPECT_FALSE(taken[f.offset + i]) << f.name << " overlaps another field";
      taken[f.offset + i] = true;
    }
  }
}

TYPED_TEST(EveryPort, IsSafeAndFiniteByDefault) {
  const TypeParam port{};
  EXPECT_TRUE(all_finite(port_type<TypeParam>(), &port));
  EXPECT_EQ(max_difference(port_type<TypeParam>(), &port, &port), 0.0);
  EXPECT_THAT(to_text(port_type<TypeParam>(), &port), testing::StartsWith(std::string(TypeParam::kName) + ":"));
  if (port_type<TypeParam>().role == Role::Actuator) {
    for (const Field& f : port_type<TypeParam>().fields) {
      for (std::size_t i = 0; i < f.count; ++i) EXPECT_EQ(get_value(&port, f, i), 0.0) << f.name;
    }
  }
}

TEST(ScalarNames, SayTheSizesAndLeadBack) {
  for (const auto& [name, scalar] :
       {std::pair{"f32", Scalar::F32}, std::pair{"f64", Scalar::F64}, std::pair{"u8", Scalar::U8},
        std::pair{"u16", Scalar::U16}, std::pair{"u32", Scalar::U32}, std::pair{"i32", Scalar::I32},
        std::pair{"i64", Scalar::I64}, std::pair{"bool", Scalar::Bool}}) {
    EXPECT_EQ(name_of(scalar), name);
    EXPECT_EQ(scalar_from(name), scalar);
  }
  EXPECT_FALSE(scalar_from("f16"));
}

}  // namespace
}  // namespace tandem::hal
