// Drawings of user functions, in W.
#include <algorithm>
#include <argos3/core/simulator/entity/composable_entity.h>
#include <argos3/core/simulator/space/space.h>
#include <argos3/plugins/simulator/visualizations/qt-opengl/qtopengl_user_functions.h>
#include <cctype>
#include <cmath>

#include "compat/argos3/simulator/session.hpp"

QColor::QColor(Qt::GlobalColor color) : red_(0), green_(0), blue_(0), alpha_(255) {
  static const unsigned char kRgb[][3] = {{255, 255, 255}, {0, 0, 0},     {255, 0, 0},   {0, 255, 0},
                                          {0, 0, 255},     {0, 255, 255}, {255, 0, 255}, {255, 255, 0},
                                          {160, 160, 160}, {128, 0, 0},   {0, 128, 0},   {0, 0, 128}};
  red_ = kRgb[color][0];
  green_ = kRgb[color][1];
  blue_ = kRgb[color][2];
}

QKeyEvent::QKeyEvent(char key) : key_(std::toupper(static_cast<unsigned char>(key))), text_(key) {}

namespace argos {

using tandem::compat::argos3::Ink;
using tandem::compat::argos3::Point;
using tandem::compat::argos3::Session;
using tandem::compat::argos3::world;

namespace {

constexpr double kPixel_m = 0.002;  // of a width that was meant in pixels

Ink ink_of(const CColor& color, double width_m, bool filled) {
  return {{color.GetRed(), color.GetGreen(), color.GetBlue()}, width_m, filled, color.GetAlpha() / 255.0};
}
Point point_of(const CVector3& v) {
  return {v.GetX(), v.GetY(), v.GetZ()};
}
double width_of(Real pixels) {
  return pixels > 1.0 ? kPixel_m * pixels : 0.0;
}

}  // namespace

CQTOpenGLUserFunctions::CQTOpenGLUserFunctions() {}
CQTOpenGLUserFunctions::~CQTOpenGLUserFunctions() {}

void CQTOpenGLUserFunctions::KeyPressed(QKeyEvent*) {}
void CQTOpenGLUserFunctions::KeyReleased(QKeyEvent*) {}
CEntity* CQTOpenGLUserFunctions::GetSelectedEntity() {
  return Session::get().selected();
}
void CQTOpenGLUserFunctions::SelectEntity(CEntity& entity) {
  Session::get().select(entity.GetId());
}
void CQTOpenGLUserFunctions::DeselectEntity() {
  Session::get().select("");
}
CQTOpenGLMainWindow& CQTOpenGLUserFunctions::GetMainWindow() {
  static CQTOpenGLMainWindow window;
  return window;
}
CQTOpenGLWidget& CQTOpenGLUserFunctions::GetQTOpenGLWidget() {
  return GetMainWindow().GetOpenGLWidget();
}
CQTOpenGLWidget& CQTOpenGLMainWindow::GetOpenGLWidget() {
  static CQTOpenGLWidget widget;
  return widget;
}
CEntity* CQTOpenGLWidget::GetSelectedEntity() {
  return Session::get().selected();
}
void CQTOpenGLWidget::SelectEntity(CEntity& entity) {
  Session::get().select(entity.GetId());
}
void CQTOpenGLWidget::DeselectEntity() {
  Session::get().select("");
}

// --- frames ---

CVector3 CQTOpenGLUserFunctions::InWorld(const CVector3& point) const {
  if (!m_bInFrame) return point;
  CVector3 turned = point;
  return m_cPosition + turned.Rotate(m_cOrientation);
}
CVector3 CQTOpenGLUserFunctions::InWorld(const CVector3& position, const CQuaternion& orientation,
                                         const CVector3& point) const {
  CVector3 turned = point;
  return InWorld(position + turned.Rotate(orientation));
}

void CQTOpenGLUserFunctions::Call(CEntity& entity) {
  for (const auto& function : m_vecFunctions) function(entity);
}

void CQTOpenGLUserFunctions::DrawAll() {
  CSpace& space = CSimulator::GetInstance().GetSpace();
  const CEntity::TVector roots =
      m_vecFunctions.empty() ? CEntity::TVector() : CEntity::TVector(space.GetRootEntityVector());
  for (CEntity* const entity : roots) {
    auto* const composed = dynamic_cast<CComposableEntity*>(entity);
    m_bInFrame = composed != nullptr && composed->HasComponent("body");
    if (m_bInFrame) {
      const SAnchor& origin = composed->GetComponent<CEmbodiedEntity>("body").GetOriginAnchor();
      m_cPosition = origin.Position;
      m_cOrientation = origin.Orientation;
    }
    Call(*entity);
  }
  m_bInFrame = false;
  DrawInWorld();
  QPainter painter;
  DrawOverlay(painter);
  std::vector<QPainter::SText> texts = painter.texts();
  std::stable_sort(texts.begin(), texts.end(), [](const auto& a, const auto& b) { return a.Y < b.Y; });
  const CVector3 corner = space.GetArenaLimits().GetMin();
  const CVector3 size = space.GetArenaSize();
  double y_m = corner.GetY() + size.GetY();
  for (const QPainter::SText& text : texts) {
    DrawText(CVector3(corner.GetX(), y_m, 0.0), text.Text,
             CColor(static_cast<UInt8>(text.Color.red()), static_cast<UInt8>(text.Color.green()),
                    static_cast<UInt8>(text.Color.blue())));
    y_m -= 0.04 * size.GetY();
  }
}

// --- shapes ---

void CQTOpenGLUserFunctions::DrawPoint(const CVector3& position, const CColor& color, Real diameter_pixels) {
  world().draw_circle(point_of(InWorld(position)), 0.5 * kPixel_m * diameter_pixels, ink_of(color, 0.0, true));
}
void CQTOpenGLUserFunctions::DrawTriangle(const CVector3& position, const CQuaternion& orientation, Real base,
                                          Real height, const CColor& color, const bool fill) {
  DrawPolygon(position, orientation,
              {CVector2(0.5 * height, 0.0), CVector2(-0.5 * height, 0.5 * base), CVector2(-0.5 * height, -0.5 * base)},
              color, fill);
}
void CQTOpenGLUserFunctions::DrawPolygon(const CVector3& position, const CQuaternion& orientation,
                                         const std::vector<CVector2>& points, const CColor& color, const bool fill) {
  if (points.size() < 3) THROW_ARGOSEXCEPTION("DrawPolygon needs three points or more, and has " << points.size())
  std::vector<Point> corners;
  for (const CVector2& p : points)
    corners.push_back(point_of(InWorld(position, orientation, CVector3(p.GetX(), p.GetY(), 0.0))));
  world().draw_polygon(corners, ink_of(color, 0.0, fill));
}
void CQTOpenGLUserFunctions::DrawCircle(const CVector3& position, const CQuaternion&, Real radius, const CColor& color,
                                        const bool fill, unsigned) {
  world().draw_circle(point_of(InWorld(position)), radius, ink_of(color, 0.0, fill));
}
void CQTOpenGLUserFunctions::DrawCylinder(const CVector3& position, const CQuaternion& orientation, Real radius,
                                          Real height, const CColor& color, unsigned) {
  const auto end = [&](double z) { return point_of(InWorld(position, orientation, CVector3(0.0, 0.0, z))); };
  world().draw_circle(end(-0.5 * height), radius, ink_of(color, 0.0, false));
  world().draw_circle(end(0.5 * height), radius, ink_of(color, 0.0, true));
}
void CQTOpenGLUserFunctions::DrawBox(const CVector3& position, const CQuaternion& orientation, const CVector3& size,
                                     const CColor& color) {
  const auto corner = [&](int i, double top) {
    const double x = (i == 1 || i == 2 ? 0.5 : -0.5) * size.GetX(), y = (i >= 2 ? 0.5 : -0.5) * size.GetY();
    return point_of(InWorld(position, orientation, CVector3(x, y, top * 0.5 * size.GetZ())));
  };
  std::vector<Point> low, high;
  for (int i = 0; i < 4; ++i) {
    low.push_back(corner(i, -1.0));
    high.push_back(corner(i, 1.0));
    world().draw_line({low.back(), high.back()}, ink_of(color, 0.0, false));
  }
  world().draw_polygon(low, ink_of(color, 0.0, false));
  world().draw_polygon(high, ink_of(color, 0.0, true));
}
void CQTOpenGLUserFunctions::DrawRay(const CRay3& ray, const CColor& color, Real width_pixels) {
  DrawSegment(ray.GetStart(), ray.GetEnd(), color, width_pixels);
}
void CQTOpenGLUserFunctions::DrawSegment(const CVector3& from, const CVector3& to, const CColor& color,
                                         Real width_pixels) {
  world().draw_line({point_of(InWorld(from)), point_of(InWorld(to))}, ink_of(color, width_of(width_pixels), false));
}
void CQTOpenGLUserFunctions::DrawText(const CVector3& position, const std::string& text, const CColor& color,
                                      const QFont&) {
  world().draw_text(point_of(InWorld(position)), text, ink_of(color, 0.0, false));
}

}  // namespace argos
