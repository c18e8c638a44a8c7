// Pictures in Python, of whatever is seen as a space.
#pragma once
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <string>

#include "core/view/picture.hpp"
#include "core/view/render.hpp"

namespace tandem::python {

/// A picture as SVG, which notebooks show.
struct Picture {
  std::string svg;

  pybind11::bytes png() const;
  /// (height, width, 3): red, green, blue.
  pybind11::array pixels() const;
  /// As notebooks ask for it; None where it cannot be made: they have the SVG.
  pybind11::object shown_png() const;
  void save(const std::string& path) const;

 private:
  hal::Result<std::string> rendered(core::PictureFormat format) const;
};

/// `options`: which run and moment it is. @throws pybind11::value_error for a size that is none
Picture picture_of(const core::Space& space, core::PictureOptions options, int size_px, bool ids, bool axes);

void bind_picture(pybind11::module_& m);

}  // namespace tandem::python
