#include "python/picture.hpp"

#include "hal/output_file.hpp"

namespace tandem::python {

namespace py = pybind11;

hal::Result<std::string> Picture::rendered(core::PictureFormat format) const {
  return format == core::PictureFormat::Svg ? hal::Result<std::string>(svg) : core::render(svg, format);
}

py::bytes Picture::png() const {
  const auto made = rendered(core::PictureFormat::Png);
  if (!made.ok()) throw std::runtime_error(made.error().message);
  return {made.value()};
}

py::object Picture::shown_png() const {
  const auto made = rendered(core::PictureFormat::Png);
  if (!made.ok()) return py::none();
  return py::bytes(made.value());
}

void Picture::save(const std::string& path) const {
  const auto format = core::picture_format(path);
  if (!format.ok()) throw py::value_error(format.error().message);
  const auto made = rendered(format.value());
  if (!made.ok()) throw std::runtime_error(made.error().message);
  const hal::Status written = hal::write_whole_file(path, "picture", made.value());
  if (!written.ok()) throw std::runtime_error(written.error().message);
}

Picture picture_of(const core::Space& space, core::PictureOptions options, int size_px, bool ids, bool axes) {
  if (size_px < 50 || size_px > 20'000) throw py::value_error("the size of a picture is 50 to 20000 pixels");
  options.look.size_px = size_px;
  options.look.ids = ids;
  options.look.axes = axes;
  return {core::to_svg(core::drawing_of(space, options), options.look)};
}

void bind_picture(py::module_& m) {
  py::class_<Picture>(m, "Picture", "A picture of a world from above. Notebooks show it.")
      .def_readonly("svg", &Picture::svg)
      .def("_repr_svg_", [](const Picture& p) { return p.svg; })
      .def("_repr_png_", &Picture::shown_png)
      .def("png", &Picture::png, "The picture as the bytes of a PNG file.")
      .def("save", &Picture::save, py::arg("path"), "Writes a file: .svg, .png or .pdf.");
}

}  // namespace tandem::python
