// Renders SVG documents as PNG or PDF.
#pragma once
#include <string>
#include <vector>

#include "hal/result.hpp"

namespace tandem::core {

/// Pixels: two u32, width and height, then the lines from the top, each pixel as blue, green, red and a spare byte.
enum class PictureFormat { Svg, Png, Pdf, Pixels };

/// Whether `render` will find its renderer: a shared object beside the program, loaded when it is needed. To be asked
/// before a run.
hal::Status can_render(PictureFormat format);

/// `svg` as a file of this format; pixels of a PNG are the document's. Error: it cannot be rendered, with the
/// renderer's words.
hal::Result<std::string> render(const std::string& svg, PictureFormat format);
/// Renders `svg` as Pixels into `pixels`; its memory and the renderer's are used again where a thread does so often.
hal::Status render_pixels(const std::string& svg, std::string& pixels);
/// Documents as the pages of one PDF, at least one, each as large as it says. Error: as above.
hal::Result<std::string> render_pages(const std::vector<std::string>& svgs);

}  // namespace tandem::core
