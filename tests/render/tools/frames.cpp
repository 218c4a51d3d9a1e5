// Writes frames of the synthetic film as PNG for inspection:
//   render_frames OUT.png WIDTH HEIGHT lit|flat light|dark|print FRAME [size [cam|nocam [exaggeration]]]
#include <png.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "tests/render/synthetic.hpp"

namespace {

bool write_png(const char* path, const beamcam::render::Image& image) {
    png_image png{};
    png.version = PNG_IMAGE_VERSION;
    png.width = static_cast<png_uint_32>(image.width), png.height = static_cast<png_uint_32>(image.height);
    png.format = PNG_FORMAT_BGRA;
    return png_image_write_to_file(&png, path, 0, image.pixels.data(), 0, nullptr) != 0;
}

}  // namespace

int main(int argc, char** argv) try {
    using namespace beamcam;
    if (argc < 7) return 2;
    test::Synthetic how;
    how.size = argc > 7 ? std::atof(argv[7]) : 1;
    how.cam = argc > 8 ? std::string(argv[8]) != "nocam" : true;
    render::FilmSetup setup = test::synthetic_film(how);
    setup.width = std::atoi(argv[2]), setup.height = std::atoi(argv[3]);
    setup.view.style = std::string(argv[4]) == "flat" ? render::Style::flat : render::Style::lit;
    const std::string theme = argv[5];
    setup.view.theme = theme == "dark"    ? render::Theme::dark
                       : theme == "print" ? render::Theme::print
                                          : render::Theme::light;
    if (argc > 9) setup.view.exaggeration = std::atof(argv[9]);
    using Clock = std::chrono::steady_clock;
    const auto start = Clock::now();
    render::Film film(std::move(setup));
    const auto made = Clock::now();
    render::Image image;
    const int frame = std::atoi(argv[6]);
    film.draw(frame, image);
    const auto first = Clock::now();
    for (int k = 0; k < film.frames(); ++k) film.draw(k, image);
    const auto all = Clock::now();
    film.draw(frame, image);
    const auto ms = [](auto d) { return std::chrono::duration<double, std::milli>(d).count(); };
    std::fprintf(stderr, "factor %g; prepare %.1f ms, first frame %.1f ms, then %.2f ms a frame\n", film.exaggeration(),
                 ms(made - start), ms(first - made), ms(all - first) / film.frames());
    return write_png(argv[1], image) ? 0 : 6;
} catch (const std::exception& e) {
    std::fprintf(stderr, "%s\n", e.what());
    return 1;
}
