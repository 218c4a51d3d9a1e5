// The text of titles and labels: any text is valid markup or says why not, and a line of it fits its room.
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "render/draw/image.hpp"
#include "render/plot/user_text.hpp"
#include "tests/fuzz/support.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace beamcam;
    using nlohmann::json;
    if (size > 200) return 0;
    // Texts come from JSON: they are UTF-8.
    const std::string text =
        json::parse(json(fuzz::text_of(data, size)).dump(-1, ' ', false, json::error_handler_t::replace));
    if (text.find('\0') != std::string::npos) return 0;
    fuzz::claim(!render::parse_markup(render::text_markup(text)).empty() || render::plain_text(text).empty(),
                "the text of a user is valid markup");
    fuzz::claim(render::to_plain(render::escaped(text)) == text, "an escaped text is shown as it is");
    static const render::Fonts fonts(false);
    static render::Image image(1, 1);
    static const render::Canvas canvas(image, fonts);
    constexpr double kRoom = 120, kUsual = 16, kSmaller = 11;
    const render::FittedText fitted = render::fitted_text(canvas, text, {.size = kUsual}, kSmaller, kRoom);
    fuzz::claim(canvas.measure(fitted.markup, {.size = fitted.size}).w <= kRoom + 1, "a fitted text fits");
    try {
        render::parse_markup(text);
    } catch (const std::invalid_argument&) {
    }
    return 0;
}
