#include "sums_loop.h"

#include <argos3/core/utility/configuration/argos_exception.h>
#include <argos3/core/utility/datatypes/byte_array.h>
#include <argos3/core/utility/datatypes/color.h>
#include <argos3/core/utility/logging/argos_log.h>
#include <argos3/core/utility/math/general.h>
#include <argos3/core/utility/math/quaternion.h>
#include <argos3/core/utility/math/range.h>
#include <argos3/core/utility/math/ray3.h>
#include <argos3/core/utility/math/vector2.h>
#include <argos3/core/utility/math/vector3.h>
#include <argos3/core/utility/string_utilities.h>
#include <cmath>
#include <limits>
#include <sstream>

template <typename T>
static void Tell(const std::string& str_key, const T& t_value) {
   LOG << "RESULT " << str_key << " " << t_value << std::endl;
}

/* Components of a vector, without the sign of a zero */
static std::string Text(const CVector3& c_v) {
   std::ostringstream cOut;
   cOut << c_v.GetX() + 0.0 << " " << c_v.GetY() + 0.0 << " " << c_v.GetZ() + 0.0;
   return cOut.str();
}

static Real InDegrees(const CRadians& c_angle) {
   return ToDegrees(c_angle).GetValue();
}

void CSumsLoop::Init(TConfigurationNode&) {
   Vectors();
   Angles();
   Quaternions();
   Ranges();
   Numbers();
   Colors();
   Bytes();
   Texts();
   Chance();
   ChanceOfMany();
}

void CSumsLoop::Vectors() {
   CVector2 cV(3.0, 4.0);
   Tell("v2.length", cV.Length());
   Tell("v2.square", cV.SquareLength());
   Tell("v2.angle", InDegrees(cV.Angle()));
   CVector2 cPolar(2.0, ToRadians(CDegrees(30.0)));
   Tell("v2.polar_y", cPolar.GetY());
   cPolar.FromPolarCoordinates(5.0, CRadians::PI_OVER_TWO);
   Tell("v2.from_polar", cPolar.GetY());
   cV.Normalize();
   Tell("v2.normal_x", cV.GetX());
   cV.Set(1.0, 0.0);
   cV.Rotate(CRadians::PI_OVER_TWO);
   Tell("v2.rotated_y", cV.GetY());
   CVector2 cSum;
   cSum += CVector2(1.0, 2.0);
   cSum -= CVector2(0.5, 0.5);
   cSum *= 4.0;
   cSum /= 2.0;
   Tell("v2.sum", ToString(cSum.GetX()) + " " + ToString(cSum.GetY()));
   Tell("v2.axes",
        ToString(CVector2::X.GetX()) + " " + ToString(CVector2::Y.GetY()) + " " + ToString(CVector2::ZERO.Length()));
   Tell("v2.dot", CVector2(1.0, 2.0).DotProduct(CVector2(3.0, 4.0)));
   Tell("v2.distance", Distance(CVector2(1.0, 1.0), CVector2(4.0, 5.0)));
   Tell("v2.square_distance", SquareDistance(CVector2(1.0, 1.0), CVector2(4.0, 5.0)));
   Tell("v2.equal", CVector2(1.0, 1.0) == CVector2(1.0, 1.0));
   std::ostringstream cOut;
   cOut << CVector2(1.5, -2.0);
   Tell("v2.written", cOut.str());

   CVector3 cW(1.0, 2.0, 2.0);
   Tell("v3.length", cW.Length());
   Tell("v3.square", cW.SquareLength());
   Tell("v3.dot", cW.DotProduct(CVector3::Y));
   CVector3 cCross(CVector3::X);
   cCross.CrossProduct(CVector3::Y);
   Tell("v3.cross", Text(cCross));
   cW.Set(1.0, 0.0, 0.0);
   cW.RotateZ(CRadians::PI_OVER_TWO);
   Tell("v3.rotated_z_y", cW.GetY());
   cW.Set(1.0, 0.0, 0.0);
   cW.RotateY(CRadians::PI_OVER_TWO);
   Tell("v3.rotated_y_z", cW.GetZ());
   cW.Set(0.0, 3.0, 0.0);
   cW.Rotate(CQuaternion(CRadians::PI_OVER_TWO, CVector3::X));
   Tell("v3.rotated_z", cW.GetZ());
   cW.Normalize();
   Tell("v3.normal", cW.Length());
   Tell("v3.z_angle", InDegrees(CVector3(0.0, 1.0, 0.0).GetZAngle()));
   Tell("v3.distance", Distance(CVector3(1.0, 2.0, 3.0), CVector3(1.0, 2.0, 7.0)));
   CVector2 cFlat;
   CVector3(1.0, 2.0, 3.0).ProjectOntoXY(cFlat);
   Tell("v3.flat", cFlat.GetY());
   const CRay3 cRay(CVector3(0.0, 0.0, 1.0), CVector3(0.0, 4.0, 1.0));
   CVector3 cPoint;
   cRay.GetPoint(cPoint, 0.25);
   Tell("ray.length", cRay.GetLength());
   Tell("ray.point", Text(cPoint));
   Tell("ray.distance", cRay.GetDistance(0.5));
}

void CSumsLoop::Angles() {
   Tell("angle.signed", InDegrees(CRadians(3.0 * ARGOS_PI / 2.0).SignedNormalize()));
   Tell("angle.unsigned", InDegrees(CRadians(-ARGOS_PI / 2.0).UnsignedNormalize()));
   Tell("angle.absolute", ToRadians(CDegrees(-90.0)).GetAbsoluteValue());
   Tell("angle.difference", InDegrees(NormalizedDifference(ToRadians(CDegrees(170.0)), ToRadians(CDegrees(-170.0)))));
   Tell("angle.cos", Cos(CRadians::PI));
   Tell("angle.sin", Sin(CRadians::PI_OVER_SIX));
   Tell("angle.acos", InDegrees(ACos(0.0)));
   Tell("angle.atan2", InDegrees(ATan2(1.0, -1.0)));
   Tell("angle.half", InDegrees(CRadians::TWO_PI / 2.0));
   Tell("angle.ratio", CRadians::PI / CRadians::PI_OVER_TWO);
   CDegrees cDegrees(270.0);
   cDegrees.SignedNormalize();
   Tell("degrees.signed", cDegrees.GetValue());
   CRadians cAngle;
   cAngle.FromValueInDegrees(180.0);
   Tell("angle.from_degrees", cAngle.GetValue());
   Tell("angle.order", CRadians::ZERO < CRadians::PI && CRadians::PI_OVER_TWO <= CRadians::PI);
}

void CSumsLoop::Quaternions() {
   CQuaternion cQ;
   Tell("q.identity", cQ.GetW());
   cQ.FromEulerAngles(ToRadians(CDegrees(90.0)), CRadians::ZERO, CRadians::ZERO);
   Tell("q.w", cQ.GetW());
   Tell("q.z", cQ.GetZ());
   CRadians cZ, cY, cX;
   cQ.FromEulerAngles(ToRadians(CDegrees(40.0)), ToRadians(CDegrees(20.0)), ToRadians(CDegrees(-30.0)));
   cQ.ToEulerAngles(cZ, cY, cX);
   Tell("q.euler_z", InDegrees(cZ));
   Tell("q.euler_y", InDegrees(cY));
   Tell("q.euler_x", InDegrees(cX));
   CQuaternion cHalf;
   cHalf.FromAngleAxis(CRadians::PI, CVector3::Z);
   CVector3 cV(1.0, 1.0, 0.0);
   cV.Rotate(cHalf);
   Tell("q.half_turn_x", cV.GetX());
   CRadians cAngle;
   CVector3 cAxis;
   cHalf.ToAngleAxis(cAngle, cAxis);
   Tell("q.angle", InDegrees(cAngle));
   Tell("q.axis_z", Abs(cAxis.GetZ()));
   const CQuaternion cQuarter(CRadians::PI_OVER_TWO, CVector3::Z);
   const CQuaternion cBoth = cQuarter * cQuarter;
   Tell("q.product_z", Abs(cBoth.GetZ()));
   const CQuaternion cBack = cQuarter * cQuarter.Inverse();
   Tell("q.inverse_w", Abs(cBack.GetW()));
}

void CSumsLoop::Ranges() {
   const CRange<Real> cUnit(0.0, 1.0);
   Tell("range.within", cUnit.WithinMinBoundIncludedMaxBoundIncluded(1.0));
   Tell("range.excluded", cUnit.WithinMinBoundIncludedMaxBoundExcluded(1.0));
   Real fValue = 7.0;
   cUnit.TruncValue(fValue);
   Tell("range.trunc", fValue);
   UInt32 unMapped = 0;
   cUnit.MapValueIntoRange(unMapped, 0.5, CRange<UInt32>(0, 100));
   Tell("range.mapped", unMapped);
   Tell("range.span", CRange<SInt32>(-3, 5).GetSpan());
   Tell("range.normal", CRange<Real>(-1.0, 1.0).NormalizeValue(0.0));
   CRange<CRadians> cAngles(-CRadians::PI_OVER_TWO, CRadians::PI_OVER_TWO);
   Tell("range.angle", cAngles.WithinMinBoundIncludedMaxBoundIncluded(CRadians::PI));
   cAngles.Set(CRadians::ZERO, CRadians::TWO_PI);
   Tell("range.angle_max", InDegrees(cAngles.GetMax()));
   std::istringstream cIn("-0.1:0.2");
   CRange<Real> cRead;
   cIn >> cRead;
   Tell("range.read", ToString(cRead.GetMin()) + " " + ToString(cRead.GetMax()));
   std::ostringstream cOut;
   cOut << cRead;
   Tell("range.written", cOut.str());
}

void CSumsLoop::Numbers() {
   Tell("number.abs", Abs(-2.5));
   Tell("number.min", Min(3, 2));
   Tell("number.max", Max<Real>(3.0, 2.0));
   Tell("number.sign", ToString(Sign(-4.0)) + " " + ToString(Sign(0.0)) + " " + ToString(Sign(9)));
   Tell("number.floor", ToString(Floor(2.7)) + " " + ToString(Floor(-2.2)));
   Tell("number.round", ToString(Round(2.5)) + " " + ToString(Round(-2.5)) + " " + ToString(Round(2.4)));
   Tell("number.square", Square(1.5));
   const UInt8 unSmall = 200;
   const UInt16 unMiddle = 60000;
   const SInt32 nLarge = -2000000000;
   Tell("number.types", ToString(static_cast<UInt32>(unSmall)) + " " + ToString(unMiddle) + " " + ToString(nLarge));
   Tell("number.sizes", ToString(sizeof(UInt8)) + ToString(sizeof(UInt16)) + ToString(sizeof(SInt32)) +
                            ToString(sizeof(UInt64)) + ToString(sizeof(Real)));
}

void CSumsLoop::Colors() {
   CColor cColor(CColor::RED);
   Tell("color.red",
        ToString(static_cast<UInt32>(cColor.GetRed())) + " " + ToString(static_cast<UInt32>(cColor.GetGreen())));
   cColor.Set(10, 20, 30);
   Tell("color.set",
        ToString(static_cast<UInt32>(cColor.GetBlue())) + " " + ToString(static_cast<UInt32>(cColor.GetAlpha())));
   cColor.Set("yellow");
   Tell("color.named", cColor == CColor::YELLOW);
   std::ostringstream cOut;
   cOut << CColor::GRAY50 << " " << CColor::GREEN;
   Tell("color.written", cOut.str());
   std::istringstream cIn("blue");
   cIn >> cColor;
   Tell("color.read", cColor != CColor::BLUE);
   Tell("color.gray", Round(CColor::WHITE.ToGrayScale()));
}

void CSumsLoop::Bytes() {
   CByteArray cBytes(10);
   cBytes[0] = 'A';
   cBytes[9] = 255;
   Tell("bytes.size", cBytes.Size());
   Tell("bytes.last", static_cast<UInt32>(cBytes[9]));
   cBytes.Clear();
   Tell("bytes.empty", cBytes.Empty());
   cBytes << static_cast<UInt8>(7) << static_cast<UInt16>(513) << static_cast<UInt32>(70000) << 2.5
          << std::string("abc");
   UInt8 unByte;
   UInt16 unWord;
   UInt32 unLong;
   double fReal;
   std::string strText;
   cBytes >> unByte >> unWord >> unLong >> fReal >> strText;
   std::ostringstream cOut;
   cOut << static_cast<UInt32>(unByte) << " " << unWord << " " << unLong << " " << fReal << " " << strText;
   Tell("bytes.stream", cOut.str());
   CByteArray cOne, cTwo;
   cOne << static_cast<UInt16>(513);
   Tell("bytes.order", ToString(static_cast<UInt32>(cOne[0])) + " " + ToString(static_cast<UInt32>(cOne[1])));
   cTwo = cOne;
   Tell("bytes.equal", cOne == cTwo);
   cTwo.Resize(4, 9);
   Tell("bytes.resized", static_cast<UInt32>(cTwo[3]));
   try {
      cTwo[4] = 1;
      Tell("bytes.beyond", "written");
   } catch (CARGoSException&) {
      Tell("bytes.beyond", "CARGoSException");
   }
}

void CSumsLoop::Texts() {
   Tell("text.number", FromString<UInt32>("42") + 1);
   Tell("text.real", FromString<Real>("0.25"));
   Tell("text.written", ToString(0.5) + ToString(7) + ToString("x"));
   Real pfValues[3];
   ParseValues<Real>("1,2.5,-3", 3, pfValues, ',');
   Tell("text.values", pfValues[0] + pfValues[1] + pfValues[2]);
   try {
      ParseValues<Real>("1,2", 3, pfValues, ',');
      Tell("text.too_few", "read");
   } catch (CARGoSException&) {
      Tell("text.too_few", "CARGoSException");
   }
}

void CSumsLoop::Chance() {
   m_pcRNG = CRandom::CreateRNG("argos");
   const CRange<Real> cReals(-2.0, 3.0);
   const CRange<SInt32> cWholes(2, 7);
   const CRange<CRadians> cTurns(CRadians::ZERO, CRadians::TWO_PI);
   bool bReals = true, bWholes = true, bTurns = true;
   SInt32 nMin = 100, nMax = -100;
   for (UInt32 i = 0; i < 10000; ++i) {
      const Real fReal = m_pcRNG->Uniform(cReals);
      bReals = bReals && fReal >= -2.0 && fReal < 3.0;
      const SInt32 nWhole = m_pcRNG->Uniform(cWholes);
      nMin = Min(nMin, nWhole);
      nMax = Max(nMax, nWhole);
      bWholes = bWholes && cWholes.WithinMinBoundIncludedMaxBoundExcluded(nWhole);
      bTurns = bTurns && cTurns.WithinMinBoundIncludedMaxBoundExcluded(m_pcRNG->Uniform(cTurns));
   }
   Tell("chance.ranges", ToString(bReals) + ToString(bWholes) + ToString(bTurns));
   Tell("chance.wholes", ToString(nMin) + " " + ToString(nMax));
   Tell("chance.unsigned", m_pcRNG->Uniform(CRange<UInt32>(5, 6)));
   CRandom::CreateCategory("corpus", 17);
   CRandom::CRNG* pcOne = CRandom::CreateRNG("corpus");
   const UInt32 unFirst = pcOne->Uniform(CRange<UInt32>(0, 1000000));
   const UInt32 unSecond = pcOne->Uniform(CRange<UInt32>(0, 1000000));
   pcOne->Reset();
   Tell("chance.reset", pcOne->Uniform(CRange<UInt32>(0, 1000000)) == unFirst);
   Tell("chance.goes_on", pcOne->Uniform(CRange<UInt32>(0, 1000000)) == unSecond && unFirst != unSecond);
   Tell("chance.category", CRandom::ExistsCategory("corpus"));
   Tell("chance.seed", GetSimulator().GetRandomSeed());
   CRandom::RemoveCategory("corpus");
}

/* Means of 20,000: five standard errors are 0.035 s */
void CSumsLoop::ChanceOfMany() {
   const UInt32 unDraws = 20000;
   Real fSum = 0.0, fSquares = 0.0, fExponential = 0.0;
   UInt32 unTrue = 0, unPoisson = 0;
   for (UInt32 i = 0; i < unDraws; ++i) {
      const Real fGaussian = m_pcRNG->Gaussian(2.0, 10.0);
      fSum += fGaussian;
      fSquares += Square(fGaussian - 10.0);
      unTrue += m_pcRNG->Bernoulli(0.3) ? 1 : 0;
      fExponential += m_pcRNG->Exponential(4.0);
      unPoisson += m_pcRNG->Poisson(3.0);
   }
   Tell("chance.gaussian_mean", fSum / unDraws);
   Tell("chance.gaussian_deviation", std::sqrt(fSquares / unDraws));
   Tell("chance.bernoulli", static_cast<Real>(unTrue) / unDraws);
   Tell("chance.exponential", fExponential / unDraws);
   Tell("chance.poisson", static_cast<Real>(unPoisson) / unDraws);
}

REGISTER_LOOP_FUNCTIONS(CSumsLoop, "sums_loop")
