// ARGoS' types: geometry by closed forms, texts, nodes, bytes, random numbers.
#include <argos3/core/utility/configuration/argos_configuration.h>
#include <argos3/core/utility/datatypes/any.h>
#include <argos3/core/utility/datatypes/byte_array.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/datatypes/set.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/core/utility/math/plane.h>
#include <argos3/core/utility/math/pose2.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/ray2.h>
#include <argos3/core/utility/math/ray3.h>
#include <argos3/core/utility/math/rng.h>
#include <argos3/core/utility/string_utilities.h>
#include <argos3/plugins/simulator/visualizations/qt-opengl/qt_types.h>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <memory>
#include <sstream>

#include "compat/argos3/facade/configuration.hpp"
#include "compat/argos3/facade/context.hpp"
#include "hal/xml/xml.hpp"

namespace argos {
namespace {

constexpr double kSmall = 1e-9;

void expect_near(const CVector3& a, const CVector3& b, double within = kSmall) {
  EXPECT_LT(Distance(a, b), within) << a << " is not " << b;
}

TEST(ArgosAngles, AreWrappedIntoTheirTurn) {
  for (int i = -50; i <= 50; ++i) {
    const double rad = 0.37 * i;
    const CRadians s = CRadians(rad).SignedNormalize(), u = CRadians(rad).UnsignedNormalize();
    EXPECT_LE(s.GetAbsoluteValue(), ARGOS_PI + kSmall);
    EXPECT_GE(u.GetValue(), 0.0);
    EXPECT_LE(u.GetValue(), 2.0 * ARGOS_PI);
    EXPECT_NEAR(std::cos(rad), Cos(s), kSmall);
    EXPECT_NEAR(std::sin(rad), Sin(u), kSmall);
  }
  EXPECT_EQ(CRadians(ARGOS_PI).SignedNormalize(), CRadians::PI);
  EXPECT_EQ(CDegrees(540.0).SignedNormalize(), CDegrees(180.0)) << "from above to the upper bound";
  EXPECT_EQ(CDegrees(-540.0).SignedNormalize(), CDegrees(-180.0));
  EXPECT_EQ(CDegrees(720.0).UnsignedNormalize(), CDegrees(360.0));
  const CDegrees fixed(5.0);
  EXPECT_EQ(+fixed, fixed);
  EXPECT_NEAR(CDegrees(-90.0).UnsignedNormalize().GetValue(), 270.0, kSmall);
  EXPECT_NEAR(ToDegrees(CRadians::PI_OVER_THREE).GetValue(), 60.0, kSmall);
  EXPECT_NEAR(ToRadians(CDegrees(45.0)).GetValue(), CRadians::PI_OVER_FOUR.GetValue(), kSmall);
  EXPECT_NEAR(NormalizedDifference(CDegrees(170.0), CDegrees(-170.0)).GetValue(), -20.0, kSmall);
  EXPECT_NEAR(NormalizedDifference(CRadians(-3.0), CRadians(3.0)).GetValue(), 2.0 * ARGOS_PI - 6.0, kSmall);
  EXPECT_EQ(ToString(CDegrees(30.0)), "CDegrees(30)");
}

TEST(ArgosAngles, HaveArithmetic) {
  EXPECT_DOUBLE_EQ((2.0 * CRadians(0.5) + CRadians(1.0) * 3 - CRadians(1.0)).GetValue(), 3.0);
  EXPECT_DOUBLE_EQ(CRadians(3.0) / CRadians(2.0), 1.5);
  EXPECT_DOUBLE_EQ((-CDegrees(10.0) / 2).GetValue(), -5.0);
  EXPECT_TRUE(CRadians::ZERO < CRadians::PI && CRadians::PI >= CRadians::PI_OVER_TWO);
  EXPECT_NEAR(ATan2(1.0, -1.0).GetValue(), 0.75 * ARGOS_PI, kSmall);
}

TEST(ArgosGeneral, FunctionsAreThoseOfARGoS) {
  EXPECT_EQ(Floor(2.7), 2);
  EXPECT_EQ(Floor(-2.2), -3);
  EXPECT_EQ(Ceil(2.2), 3);
  EXPECT_EQ(Round(2.5), 3);
  EXPECT_EQ(Round(-2.5), -3);
  EXPECT_EQ(Sign(-0.1), -1);
  EXPECT_EQ(Abs(-3), 3);
  EXPECT_EQ(Max(2, 3), 3);
  EXPECT_DOUBLE_EQ(Mod(-7.0, 3.0), -1.0);
  EXPECT_DOUBLE_EQ(Interpolate(1.5, {{0.0, 0.0}, {1.0, 10.0}, {2.0, 30.0}}), 20.0);
  EXPECT_DOUBLE_EQ(Interpolate(3.0, {{0.0, 0.0}, {1.0, 10.0}, {2.0, 30.0}}), 50.0);
}

TEST(ArgosRanges, HoldTruncateWrapAndMap) {
  const CRange<Real> range(-1.0, 3.0);
  EXPECT_TRUE(range.WithinMinBoundIncludedMaxBoundIncluded(3.0));
  EXPECT_FALSE(range.WithinMinBoundIncludedMaxBoundExcluded(3.0));
  Real value = 7.5;
  range.WrapValue(value);
  EXPECT_DOUBLE_EQ(value, -0.5);
  value = 9.0;
  range.TruncValue(value);
  EXPECT_DOUBLE_EQ(value, 3.0);
  Real mapped = 0.0;
  range.MapValueIntoRange(mapped, 1.0, CRange<Real>(0.0, 10.0));
  EXPECT_DOUBLE_EQ(mapped, 5.0);
  EXPECT_EQ(ToString(FromString<CRange<Real>>("-0.1:0.2")), "-0.1:0.2");
  EXPECT_THROW(FromString<CRange<Real>>("1"), CARGoSException);
  EXPECT_TRUE(range == CRange<Real>(-1.0, 3.0) && range != CRange<Real>(-1.0, 4.0));
  CDegrees turned;
  CRange<CRadians>(CRadians::ZERO, CRadians::PI)
      .MapValueIntoRange(turned, CRadians::PI_OVER_TWO, CRange<CDegrees>(CDegrees(0.0), CDegrees(90.0)));
  EXPECT_NEAR(turned.GetValue(), 45.0, kSmall);
  EXPECT_EQ(CRange<Real>(2.0, 2.0).NormalizeValue(2.0), 0.0) << "without length";
}

TEST(ArgosRanges, WrapWithoutLoops) {
  const CRange<Real> range(-1.0, 3.0);
  const Real infinity = std::numeric_limits<Real>::infinity();
  Real value = infinity;
  range.WrapValue(value);
  EXPECT_EQ(value, infinity);
  value = 1e300;
  range.WrapValue(value);
  EXPECT_TRUE(range.WithinMinBoundIncludedMaxBoundIncluded(value)) << value;
  value = 5.0;
  CRange<Real>(2.0, 2.0).WrapValue(value);
  EXPECT_EQ(value, 5.0);
  for (const auto& [whole, wrapped] : {std::pair{-7, 1}, {-1, 3}, {0, 0}, {4, 4}, {5, 1}, {9, 1}}) {
    SInt32 v = whole;
    CRange<SInt32>(0, 4).WrapValue(v);
    EXPECT_EQ(v, wrapped) << whole;
  }
}

TEST(ArgosVectors, TurnAndMultiply) {
  EXPECT_NEAR(CVector2(2.0, CRadians::PI_OVER_SIX).GetY(), 1.0, kSmall);
  EXPECT_NEAR(CVector2(1.0, 0.0).Rotate(CRadians::PI_OVER_TWO).GetY(), 1.0, kSmall);
  EXPECT_DOUBLE_EQ(CVector2(3.0, 4.0).Normalize().Length(), 1.0);
  EXPECT_DOUBLE_EQ(CVector2(1.0, 2.0).CrossProduct(CVector2(3.0, 4.0)), -2.0);
  expect_near(CVector3(CVector3::X).CrossProduct(CVector3::Y), CVector3::Z);
  expect_near(CVector3(CVector3::Y).RotateX(CRadians::PI_OVER_TWO), CVector3::Z);
  expect_near(CVector3(CVector3::Z).RotateY(CRadians::PI_OVER_TWO), CVector3::X);
  expect_near(CVector3(CVector3::X).RotateZ(CRadians::PI_OVER_TWO), CVector3::Y);
  Real length = 0.0;
  CRadians inclination, azimuth;
  CVector3(2.0, CRadians(0.7), CRadians(-1.1)).ToSphericalCoords(length, inclination, azimuth);
  EXPECT_NEAR(length, 2.0, kSmall);
  EXPECT_NEAR(inclination.GetValue(), 0.7, kSmall);
  EXPECT_NEAR(azimuth.GetValue(), -1.1, kSmall);
  EXPECT_THROW(CVector3()[3], CARGoSException);
  EXPECT_EQ(FromString<CVector3>("1,2.5,-3"), CVector3(1.0, 2.5, -3.0));
  EXPECT_EQ(ToString(CVector2(1.0, -2.0)), "1,-2");
  const CVector3 v(0.1, 0.2, 0.7);
  EXPECT_NEAR(v.GetAngleWith(v * 3.0).GetValue(), 0.0, 1e-7) << "whatever rounding does";
  EXPECT_EQ(ACos(1.0 + 1e-15).GetValue(), 0.0);
  EXPECT_EQ(ASin(-1.0 - 1e-15), -CRadians::PI_OVER_TWO);
}

TEST(ArgosQuaternions, TurnAsTheirAnglesSay) {
  for (const double z : {-2.5, -0.4, 0.0, 1.3, 3.0}) {
    for (const double y : {-1.2, 0.0, 0.9}) {
      for (const double x : {-3.0, 0.0, 0.6}) {
        const CQuaternion q = CQuaternion().FromEulerAngles(CRadians(z), CRadians(y), CRadians(x));
        const CVector3 v(0.3, -1.2, 2.0);
        const CVector3 turned = CVector3(v).RotateX(CRadians(x)).RotateY(CRadians(y)).RotateZ(CRadians(z));
        expect_near(CVector3(v).Rotate(q), turned);
        expect_near(static_cast<CRotationMatrix3>(q) * v, turned);
        expect_near(CRotationMatrix3(CRadians(z), CRadians(y), CRadians(x)) * v, turned);
        expect_near(CVector3(v).Rotate(static_cast<CQuaternion>(static_cast<CRotationMatrix3>(q))), turned);
        CRadians az, ay, ax;
        q.ToEulerAngles(az, ay, ax);
        EXPECT_NEAR(az.GetValue(), z, 1e-7);
        EXPECT_NEAR(ay.GetValue(), y, 1e-7);
        EXPECT_NEAR(ax.GetValue(), x, 1e-7);
        CRadians angle;
        CVector3 axis;
        q.ToAngleAxis(angle, axis);
        expect_near(CVector3(v).Rotate(CQuaternion(angle, axis)), turned, 1e-7);
        expect_near(CVector3(turned).Rotate(q.Inverse()), v);
      }
    }
  }
}

TEST(ArgosQuaternions, KeepSmallAngles) {
  CRadians angle;
  CVector3 axis;
  CQuaternion(CRadians(1e-9), CVector3::X).ToAngleAxis(angle, axis);
  EXPECT_NEAR(angle.GetValue(), 1e-9, 1e-20);
  expect_near(axis, CVector3::X);
}

TEST(ArgosQuaternions, LeadFromOneVectorToAnother) {
  const std::vector<CVector3> all = {{1, 0, 0}, {0, -2, 0}, {-1, 0, 0}, {0.3, 0.4, -0.5}, {0, 0, 3}, {-0.3, -0.4, 0.5}};
  for (const CVector3& a : all) {
    for (const CVector3& b : all)
      expect_near(CVector3(a).Normalize().Rotate(CQuaternion(a, b)), CVector3(b).Normalize(), 1e-6);
  }
  CRadians z, y, x;
  CQuaternion().FromEulerAngles(CRadians(0.4), CRadians::PI_OVER_TWO, CRadians(0.1)).ToEulerAngles(z, y, x);
  expect_near(
      CVector3(1, 2, 3).Rotate(CQuaternion().FromEulerAngles(z, y, x)),
      CVector3(1, 2, 3).Rotate(CQuaternion().FromEulerAngles(CRadians(0.4), CRadians::PI_OVER_TWO, CRadians(0.1))),
      1e-6);
}

TEST(ArgosRays, MeetWhereTheyMeet) {
  EXPECT_TRUE(CRay2({0, 0}, {2, 2}).Intersects(CRay2({0, 2}, {2, 0})));
  EXPECT_FALSE(CRay2({0, 0}, {2, 2}).Intersects(CRay2({0, 2}, {0.9, 1.1})));
  EXPECT_FALSE(CRay2({0, 0}, {1, 0}).Intersects(CRay2({0, 1}, {1, 1})));
  const CRay3 ray(CVector3(0, 0, 2), CVector3(0, 0, -1), 4.0);
  CVector3 point;
  EXPECT_TRUE(ray.Intersects(CPlane(CVector3(5, 5, 1), CVector3::Z), point));
  expect_near(point, CVector3(0, 0, 1));
  EXPECT_FALSE(ray.Intersects(CPlane(CVector3(5, 5, 3), CVector3::Z), point));
  EXPECT_DOUBLE_EQ(ray.GetLength(), 4.0);
  EXPECT_DOUBLE_EQ(ray.GetDistance(0.25), 1.0);
  EXPECT_EQ(CPose2(1.0, 2.0, ARGOS_PI / 2.0) * CVector2::ZERO, CVector2(1.0, 2.0));
}

TEST(ArgosMatrices, HaveDeterminants) {
  const Real all[] = {2, 1, 0, 1, 3, 1, 0, 1, 4};
  EXPECT_NEAR(CSquareMatrix<3>(all).GetDeterminant(), 18.0, kSmall);
  EXPECT_EQ(CSquareMatrix<3>(all).GetTransposed(), CSquareMatrix<3>(all));
  EXPECT_NEAR((static_cast<CMatrix<1, 2>>(CVector2(3, 4)) * static_cast<CMatrix<2, 1>>(CVector2(3, 4)))(0), 25.0,
              kSmall);
}

TEST(ArgosTexts, AreConverted) {
  EXPECT_EQ(ToString(true), "true");
  EXPECT_EQ(ToString(static_cast<UInt8>(7)), "7");
  EXPECT_EQ(FromString<int>("12"), 12);
  EXPECT_EQ(FromString<UInt8>("65"), 65) << "a number, not a character";
  EXPECT_EQ(FromString<CRange<UInt8>>("6:200").GetMax(), 200);
  EXPECT_THROW(FromString<UInt8>("300"), CARGoSException);
  EXPECT_THROW(FromString<SInt8>("-129"), CARGoSException);
  EXPECT_THROW(FromString<CVector3>("1,,3"), CARGoSException);
  EXPECT_THROW(FromString<CVector3>("1,x,3"), CARGoSException);
  EXPECT_THROW(FromString<CVector3>("1,2,3,4"), CARGoSException);
  EXPECT_THROW(FromString<CQuaternion>("1,2"), CARGoSException);
  std::vector<std::string> tokens;
  Tokenize("a, b,,c", tokens, ", ");
  EXPECT_THAT(tokens, testing::ElementsAre("a", "b", "c"));
  EXPECT_TRUE(MatchPattern("epuck_12", "epuck_*"));
  EXPECT_TRUE(MatchPattern("fb1", "f?1"));
  EXPECT_FALSE(MatchPattern("fb1", "e*"));
  std::string text = "x $TANDEM_TEST_WORD y";
  ::setenv("TANDEM_TEST_WORD", "z", 1);
  EXPECT_EQ(ExpandEnvVariables(text), "x z y");
  EXPECT_EQ(StringToUpperCase("aB"), "AB");
  Replace(text, "z", "zz");
  EXPECT_EQ(text, "x zz y");
}

TEST(ArgosExceptions, TellTheInnerOne) {
  try {
    try {
      THROW_ARGOSEXCEPTION("inner " << 1);
    } catch (CARGoSException& e) {
      THROW_ARGOSEXCEPTION_NESTED("outer " << 2, e);
    }
  } catch (const std::exception& e) {
    EXPECT_STREQ(e.what(), "outer 2\ninner 1");
  }
}

TEST(ArgosColors, AreNamesOrNumbers) {
  EXPECT_EQ(ToString(CColor::ORANGE), "orange");
  CColor color;
  color.Set("10,20,30,40");
  EXPECT_EQ(ToString(color), "10,20,30,40");
  EXPECT_EQ(FromString<CColor>("magenta"), CColor::MAGENTA);
  EXPECT_THROW(color.Set("reddish"), CARGoSException);
  EXPECT_THROW(color.Set("1,2,300"), CARGoSException);
  EXPECT_EQ(CColor(255, 0, 0, 0).Blend(CColor::BLUE), CColor::BLUE);
}

TEST(ArgosBytes, ComeBackInTheOrderInWhichTheyWent) {
  CByteArray bytes;
  bytes << static_cast<UInt8>(1) << static_cast<SInt16>(-2) << static_cast<UInt32>(0xDEADBEEF) << -0.1 << 3.25F
        << std::string("text") << static_cast<unsigned long>(99);
  EXPECT_EQ(bytes[1], 0xFF) << "the highest byte first";
  UInt8 a = 0;
  SInt16 b = 0;
  UInt32 c = 0;
  double d = 0.0;
  float e = 0.0F;
  std::string f;
  bytes >> a >> b >> c >> d >> e >> f;
  EXPECT_EQ(a, 1);
  EXPECT_EQ(b, -2);
  EXPECT_EQ(c, 0xDEADBEEFU);
  EXPECT_NEAR(d, -0.1, 1e-15);
  EXPECT_EQ(e, 3.25F);
  EXPECT_EQ(f, "text");
  EXPECT_EQ(bytes.PopFront<unsigned long>(), 99U);
  EXPECT_TRUE(bytes.Empty());
  EXPECT_THROW(bytes >> a, CARGoSException);
  EXPECT_THROW(bytes[0], CARGoSException);
}

enum EState { STATE_WAIT = 3 };
enum class EMode : UInt16 { FAST = 0x102 };

TEST(ArgosBytes, CarryEnumeratorsAndWhatIsNoNumber) {
  CByteArray bytes;
  const Real infinity = std::numeric_limits<Real>::infinity();
  bytes << STATE_WAIT << EMode::FAST << infinity << -infinity << std::nan("");
  const CByteArray& all = bytes;
  const std::unique_ptr<CByteArray> mode(all(4, 6));
  EXPECT_EQ(ToString(*mode), "CByteArray {1, 2}");
  EXPECT_EQ(bytes.PopFront<EState>(), STATE_WAIT);
  EXPECT_EQ(bytes.PopFront<EMode>(), EMode::FAST);
  EXPECT_EQ(bytes.PopFront<double>(), infinity);
  EXPECT_EQ(bytes.PopFront<double>(), -infinity);
  EXPECT_TRUE(std::isnan(bytes.PopFront<double>()));
}

TEST(ArgosQt, HasTexts) {
  EXPECT_EQ(("robots: " + QString::number(5) + QString::number(7U) + " of " + QString::number(0.5)).toStdString(),
            "robots: 57 of 0.5");
  EXPECT_EQ(QString("%2 after %1, %1").arg("a").arg(3).toStdString(), "3 after a, a");
}

TEST(ArgosSets, AreInOrderWithoutDoubles) {
  CSet<int> set;
  for (const int one : {3, 1, 2, 3}) set.insert(one);
  EXPECT_EQ(set.size(), 3U);
  EXPECT_EQ(set.first(), 1);
  EXPECT_TRUE(set.exists(2));
  set.erase(2);
  EXPECT_FALSE(set.exists(2));
  EXPECT_EQ(any_cast<std::string>(CAny(std::string("x"))), "x");
  EXPECT_THROW(any_cast<int>(CAny(1.0)), CARGoSException);
}

TEST(ArgosNodes, AreReadChangedAndWritten) {
  ticpp::Document document;
  document.Parse("<a x=\"1\"><b n=\"first\"/><c/><b n=\"second\"/></a>");
  TConfigurationNode& a = *document.FirstChildElement();
  std::string names;
  TConfigurationNodeIterator it("b");
  for (it = it.begin(&a); it != it.end(); ++it) names += it->GetAttribute("n") + ";";
  EXPECT_EQ(names, "first;second;");
  std::size_t children = 0;
  TConfigurationNodeIterator all;
  for (all = all.begin(&a); all != all.end(); ++all) ++children;
  EXPECT_EQ(children, 3U);
  TConfigurationAttributeIterator attribute;
  attribute = attribute.begin(&a);
  EXPECT_EQ(attribute->Name(), "x");
  UInt32 x = 0, y = 0;
  GetNodeAttributeOrDefault(a, "x", x, 5U);
  GetNodeAttributeOrDefault(a, "y", y, 5U);
  EXPECT_EQ(x, 1U);
  EXPECT_EQ(y, 5U);
  TConfigurationNode same = a;
  SetNodeAttribute(same, "y", true);
  bool flag = false;
  GetNodeAttribute(a, "y", flag);
  EXPECT_TRUE(flag) << "a copy is the same element";
  TConfigurationNode d("d");
  SetNodeAttribute(d, "z", 2.5);
  AddChildNode(a, d);
  EXPECT_THAT(ToString(a), testing::HasSubstr("<d z=\"2.5\"/>"));
  SetNodeAttribute(d, "exact", 0.123456789);
  Real exact = 0.0;
  GetNodeAttribute(d, "exact", exact);
  EXPECT_EQ(exact, 0.123456789);
  SetNodeAttribute(d, "byte", 300);
  UInt8 byte = 0;
  EXPECT_THROW(GetNodeAttribute(d, "byte", byte), CARGoSException);
  EXPECT_THROW(GetNodeAttribute(a, "none", x), CARGoSException);
  EXPECT_THROW(GetNode(a, "none"), CARGoSException);
  EXPECT_THROW(document.Parse("<a"), ticpp::Exception);
  EXPECT_THROW(document.LoadFile("/nowhere.argos"), ticpp::Exception);
}

TEST(ArgosNodes, KnowTheirParents) {
  tandem::hal::Problems problems;
  const auto root = tandem::compat::argos3::to_node(
      tandem::hal::read_xml_text("<params><first/><last/></params>", "params", problems).value(), true);
  ticpp::Element& first = *root->FirstChildElement("first");
  EXPECT_EQ(first.Parent(), root.get());
  EXPECT_EQ(first.NextSibling()->Value(), "last");
  EXPECT_EQ(root->FirstChildElement("last")->Value(), "last") << "a literal is a name, and no bool";
  EXPECT_EQ(first.NextSiblingElement("first", false), nullptr);
  EXPECT_EQ(root->Parent(false), nullptr);
}

/// What a context is told.
struct Told : tandem::compat::argos3::Context {
  void tell(bool error, std::string_view text) override { all += (error ? "!" : "") + std::string(text) + "|"; }
  std::string all;
};

TEST(ArgosLog, IsToldLineByLine) {
  Told told;
  {
    const tandem::compat::argos3::ContextScope scope(told);
    LOG << "a " << 1 << std::endl << "b";
    EXPECT_EQ(told.all, "a 1|");
    LOG.Flush();
    LOGERR << std::hex << 255 << '\n' << static_cast<UInt8>(9);
    std::ostream& stream = LOG;
    stream << "c" << std::endl;
  }
  EXPECT_EQ(told.all, "a 1|b|!ff|c|!9|");
}

TEST(ArgosLog, HasOneFormat) {
  Told told;
  const tandem::compat::argos3::ContextScope scope(told);
  const std::streamsize before = LOG.precision(3);
  LOG << 0.123456 << std::setprecision(2) << " " << LOG.precision() << std::endl;
  LOG.precision(before);
  EXPECT_EQ(told.all, "0.123 2|");
}

TEST(ArgosChance, HasTheDistributionsThatItSays) {
  Told robot;
  robot.set_seed(17);
  const tandem::compat::argos3::ContextScope scope(robot);
  CRandom::CRNG& rng = *CRandom::CreateRNG("argos");
  constexpr int kDraws = 20000;
  double uniform = 0, normal = 0, square = 0, exponential = 0, poisson = 0, many = 0, heads = 0;
  std::map<int, int> whole;
  for (int i = 0; i < kDraws; ++i) {
    const Real u = rng.Uniform(CRange<Real>(2.0, 4.0));
    ASSERT_TRUE(u >= 2.0 && u < 4.0);
    uniform += u;
    const Real n = rng.Gaussian(2.0, 1.0);
    normal += n;
    square += (n - 1.0) * (n - 1.0);
    exponential += rng.Exponential(3.0);
    poisson += rng.Poisson(2.5);
    many += rng.Poisson(100.0);
    heads += rng.Bernoulli(0.3) ? 1 : 0;
    ++whole[rng.Uniform(CRange<SInt32>(-1, 2))];
  }
  EXPECT_NEAR(uniform / kDraws, 3.0, 0.02);
  EXPECT_NEAR(normal / kDraws, 1.0, 0.06);
  EXPECT_NEAR(square / kDraws, 4.0, 0.2);
  EXPECT_NEAR(exponential / kDraws, 3.0, 0.1);
  EXPECT_NEAR(poisson / kDraws, 2.5, 0.05);
  EXPECT_NEAR(many / kDraws, 100.0, 0.4);
  EXPECT_NEAR(heads / kDraws, 0.3, 0.015);
  EXPECT_EQ(whole.size(), 3U) << "the upper bound is not drawn";
  EXPECT_NEAR(rng.Uniform(CRange<CRadians>(CRadians::ZERO, CRadians::TWO_PI)).GetValue(), ARGOS_PI, ARGOS_PI);
}

TEST(ArgosChance, BeginsAnewAndHasCategories) {
  Told one, other;
  one.set_seed(1);
  other.set_seed(2);
  CRandom::CRNG *a = nullptr, *b = nullptr, *c = nullptr;
  {
    const tandem::compat::argos3::ContextScope scope(one);
    a = CRandom::CreateRNG("argos");
    b = CRandom::CreateRNG("argos");
  }
  {
    const tandem::compat::argos3::ContextScope scope(other);
    c = CRandom::CreateRNG("argos");
  }
  const CRange<Real> unit(0.0, 1.0);
  const Real first = a->Uniform(unit);
  EXPECT_NE(first, b->Uniform(unit));
  EXPECT_NE(first, c->Uniform(unit));
  one.set_seed(1);
  EXPECT_EQ(a->Uniform(unit), first);
  a->Reset();
  EXPECT_EQ(a->Uniform(unit), first);
  one.set_seed(2);
  EXPECT_EQ(a->Uniform(unit), [&] {
    c->Reset();
    return c->Uniform(unit);
  }());
  EXPECT_TRUE(CRandom::CreateCategory("mine", 5));
  EXPECT_FALSE(CRandom::CreateCategory("mine", 5));
  EXPECT_EQ(CRandom::GetSeedOf("mine"), 5U);
  EXPECT_THROW(CRandom::CreateRNG("none"), CARGoSException);
  const Real mine = CRandom::CreateRNG("mine")->Uniform(unit);
  CRandom::RemoveCategory("mine");
  CRandom::CreateCategory("mine", 5);
  EXPECT_EQ(CRandom::CreateRNG("mine")->Uniform(unit), mine);
  CRandom::RemoveCategory("mine");
  CRandom::CreateCategory("world", 42);
  const auto of_world = [&](Told& context) {
    const tandem::compat::argos3::ContextScope scope(context);
    return CRandom::CreateRNG("world");
  };
  Told loops, robot;
  loops.set_seed(1);
  robot.set_seed(1, "ep0");
  CRandom::CRNG *of_loops = of_world(loops), *of_robot = of_world(robot);
  const Real drawn = of_loops->Uniform(unit), drawn_by_robot = of_robot->Uniform(unit);
  EXPECT_NE(drawn, drawn_by_robot);
  loops.set_seed(2);
  EXPECT_EQ(of_loops->Uniform(unit), drawn) << "a category of one's own has its seed, whatever the run's";
  CRandom::GetCategory("world").ResetRNGs();
  EXPECT_EQ(of_robot->Uniform(unit), drawn_by_robot);
  CRandom::SetSeedOf("world", 43);
  CRandom::GetCategory("world").ReseedRNGs();
  const Real other_world = of_loops->Uniform(unit);
  EXPECT_NE(other_world, drawn);
  EXPECT_NE(of_robot->Uniform(unit), drawn_by_robot);
  CRandom::Reset();
  EXPECT_EQ(of_loops->Uniform(unit), other_world);
  CRandom::RemoveCategory("world");
  CRandom::CRNG copy(*a);
  EXPECT_EQ(copy.Uniform(unit), a->Uniform(unit));
}

}  // namespace
}  // namespace argos
