// The renderer, a shared object of its own: librsvg and its libraries would cost every start 4 ms and 7 MB, and most
// runs draw nothing. It renders the very SVG document: drawing with cairo directly would load less, but be a second
// drawing.
#include <bit>
#include <cairo-pdf.h>
#include <cmath>
#include <cstdint>
#include <librsvg/rsvg.h>
#include <memory>

#include "core/view/render.hpp"

namespace tandem::core {
namespace {

template <auto release>
struct Release {
  template <class T>
  void operator()(T* object) const noexcept {
    release(object);
  }
};
using Handle = std::unique_ptr<RsvgHandle, Release<&g_object_unref>>;
using Stream = std::unique_ptr<GInputStream, Release<&g_object_unref>>;
using Surface = std::unique_ptr<cairo_surface_t, Release<&cairo_surface_destroy>>;
using Context = std::unique_ptr<cairo_t, Release<&cairo_destroy>>;

constexpr double kPoints_per_px = 72.0 / 96.0;  // CSS' pixel and PDF's unit

hal::Error failed(const std::string& why) {
  return {"the picture cannot be rendered: " + why};
}

hal::Error failed(GError* error) {
  hal::Error told = failed(error != nullptr ? error->message : "unknown reason");
  g_clear_error(&error);
  return told;
}

cairo_status_t append(void* text, const unsigned char* data, unsigned int size) {
  static_cast<std::string*>(text)->append(reinterpret_cast<const char*>(data), size);
  return CAIRO_STATUS_SUCCESS;
}

void append_pixels(cairo_surface_t* surface, std::string& text) {
  static_assert(std::endian::native == std::endian::little);
  cairo_surface_flush(surface);
  const auto width = static_cast<std::uint32_t>(cairo_image_surface_get_width(surface));
  const auto height = static_cast<std::uint32_t>(cairo_image_surface_get_height(surface));
  const auto stride = static_cast<std::size_t>(cairo_image_surface_get_stride(surface));
  const auto* const data = reinterpret_cast<const char*>(cairo_image_surface_get_data(surface));
  text.clear();
  text.reserve(8 + std::size_t{4} * width * height);
  text.append(reinterpret_cast<const char*>(&width), sizeof width);
  text.append(reinterpret_cast<const char*>(&height), sizeof height);
  for (std::uint32_t line = 0; line < height; ++line) text.append(data + line * stride, std::size_t{4} * width);
}

struct Document {
  Handle handle;
  double width_px = 0.0, height_px = 0.0;
};

hal::Result<Document> read_document(const std::string& svg) {
  GError* error = nullptr;
  const Stream stream(g_memory_input_stream_new_from_data(svg.data(), static_cast<gssize>(svg.size()), nullptr));
  // Large swarms have more elements than librsvg takes from strangers.
  Document read{
      Handle(rsvg_handle_new_from_stream_sync(stream.get(), nullptr, RSVG_HANDLE_FLAG_UNLIMITED, nullptr, &error))};
  if (read.handle == nullptr) return failed(error);
  if (rsvg_handle_get_intrinsic_size_in_pixels(read.handle.get(), &read.width_px, &read.height_px) == 0)
    return failed("it has no size");
  return read;
}

hal::Status draw(const Document& document, cairo_t* context, double scale) {
  GError* error = nullptr;
  const RsvgRectangle page{0.0, 0.0, scale * document.width_px, scale * document.height_px};
  if (rsvg_handle_render_document(document.handle.get(), context, &page, &error) == 0) return failed(error);
  return {};
}

hal::Status render_pdf(const std::vector<Document>& documents, std::string& out) {
  const Surface surface(cairo_pdf_surface_create_for_stream(&append, &out, 1.0, 1.0));
  const Context context(cairo_create(surface.get()));
  for (const Document& document : documents) {
    cairo_pdf_surface_set_size(surface.get(), kPoints_per_px * document.width_px, kPoints_per_px * document.height_px);
    if (const hal::Status drawn = draw(document, context.get(), kPoints_per_px); !drawn.ok()) return drawn;
    cairo_show_page(context.get());
  }
  cairo_surface_finish(surface.get());
  cairo_status_t status = cairo_status(context.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface.get());
  return status == CAIRO_STATUS_SUCCESS ? hal::Status() : hal::Status(failed(cairo_status_to_string(status)));
}

Surface image_for(const Document& document) {
  return Surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::ceil(document.width_px)),
                                            static_cast<int>(std::ceil(document.height_px))));
}

hal::Status draw_image(const Document& document, cairo_surface_t* surface) {
  const Context context(cairo_create(surface));
  if (const hal::Status drawn = draw(document, context.get(), 1.0); !drawn.ok()) return drawn;
  const cairo_status_t status = cairo_status(context.get());
  return status == CAIRO_STATUS_SUCCESS ? hal::Status() : hal::Status(failed(cairo_status_to_string(status)));
}

hal::Status render_png(const Document& document, std::string& out) {
  const Surface surface = image_for(document);
  if (hal::Status drawn = draw_image(document, surface.get()); !drawn.ok()) return drawn;
  cairo_status_t status = cairo_surface_write_to_png_stream(surface.get(), &append, &out);
  cairo_surface_finish(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) status = cairo_surface_status(surface.get());
  return status == CAIRO_STATUS_SUCCESS ? hal::Status() : hal::Status(failed(cairo_status_to_string(status)));
}

/// On the surface of the frame before, where that has the size: fresh memory costs more than what is drawn on it. The
/// document covers all of it.
hal::Status render_frame(const Document& document, std::string& out) {
  static thread_local Surface kept;
  if (kept == nullptr || cairo_image_surface_get_width(kept.get()) != static_cast<int>(std::ceil(document.width_px)) ||
      cairo_image_surface_get_height(kept.get()) != static_cast<int>(std::ceil(document.height_px)))
    kept = image_for(document);
  if (hal::Status drawn = draw_image(document, kept.get()); !drawn.ok()) return drawn;
  append_pixels(kept.get(), out);
  return {};
}

hal::Status render_here(const std::vector<std::string>& svgs, PictureFormat format, std::string& out) {
  std::vector<Document> documents;
  for (const std::string& svg : svgs) {
    auto document = read_document(svg);
    if (!document.ok()) return document.error();
    documents.push_back(std::move(document).value());
  }
  if (format == PictureFormat::Pdf) return render_pdf(documents, out);
  return format == PictureFormat::Pixels ? render_frame(documents.front(), out) : render_png(documents.front(), out);
}

}  // namespace
}  // namespace tandem::core

extern "C" __attribute__((visibility("default"))) bool tandem_render(const std::vector<std::string>& svgs,
                                                                     tandem::core::PictureFormat format,
                                                                     std::string& out);

/// `out`, empty but for Pixels, becomes the picture; or, when false is returned, what is wrong.
bool tandem_render(const std::vector<std::string>& svgs, tandem::core::PictureFormat format, std::string& out) {
  const tandem::hal::Status rendered = tandem::core::render_here(svgs, format, out);
  if (!rendered.ok()) out = rendered.error().message;
  return rendered.ok();
}
