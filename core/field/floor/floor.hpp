// The floor's shade: even grey, a picture, or painted by hooks.
#pragma once
#include "core/field/point_field.hpp"
#include "core/field/raster.hpp"
#include "hal/catalog.hpp"

namespace tandem::core {

/// Reflectance over the arena, 0 black to 1 white.
class FloorField final : public PointField<FloorField> {
 public:
  static constexpr float kGrey = 0.5F;  ///< by default

  /// `pixels_per_m`: of one that hooks paint; 0: they do not. `bare`: its shade where they leave it out.
  FloorField(const RasterArea& area, double pixels_per_m, Raster raster = {}, float bare = kGrey)
      : area_(area), pixels_per_m_(pixels_per_m), raster_(std::move(raster)), bare_(bare) {}

  double at(const SpaceStores& /*stores*/, double x_m, double y_m, double /*z_m*/) const noexcept override {
    return static_cast<double>(raster_.empty() ? kGrey : raster_.at(x_m, y_m));
  }
  std::optional<hal::Rgb> color(const SpaceStores& /*stores*/, double x_m, double y_m) const noexcept override {
    return raster_.color_at(x_m, y_m);
  }
  bool painted_by_hooks() const noexcept override { return pixels_per_m_ > 0.0; }
  bool unpainted() const noexcept override { return unpainted_; }
  void repaint() noexcept override { unpainted_ = true; }
  void paint(const Painter& painter) override;
  std::uint64_t mark() const noexcept override { return raster_.mark(); }
  std::shared_ptr<const void> keep() const override;
  void put_back(const std::shared_ptr<const void>& kept) override;
  bool remember(hal::Archive& archive) override {
    archive(unpainted_, raster_);
    return true;
  }
  FieldGrid grid() const noexcept override { return {raster_.columns(), raster_.lines()}; }

 private:
  struct Kept {
    Raster raster;
    bool unpainted;
  };
  RasterArea area_;
  double pixels_per_m_;
  Raster raster_;
  float bare_;
  bool unpainted_ = true;
};

void register_floor(hal::Registrar& registrar);

}  // namespace tandem::core
