#include "python/picture.hpp"

#include <cstdint>
#include <cstring>

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

py::array Picture::pixels() const {
  const auto made = rendered(core::PictureFormat::Pixels);
  if (!made.ok()) throw std::runtime_error(made.error().message);
  std::uint32_t size[2];
  std::memcpy(size, made.value().data(), sizeof size);
  const std::size_t width = size[0], height = size[1];
  py::array_t<std::uint8_t> pixels({height, width, std::size_t{3}});
  std::uint8_t* to = pixels.mutable_data();
  const char* from = made.value().data() + sizeof size;
  for (std::size_t i = 0; i < width * height; ++i, from += 4, to += 3) {
    for (std::size_t color = 0; color < 3; ++color) to[color] = static_cast<std::uint8_t>(from[2 - color]);
  }
  return pixels;
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
      .def("pixels", &Picture::pixels,
           "The picture as an array: (height, width, 3), red, green and blue from 0 to 255.")
      .def("save", &Picture::save, py::arg("path"), "Writes a file: .svg, .png or .pdf.");
}

}  // namespace tandem::python
