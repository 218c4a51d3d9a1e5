// Names of files, and keys that several outputs share.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "scenes/format/absent.hpp"
#include "scenes/format/object_reader.hpp"
#include "scenes/format/value_formats.hpp"
#include "scenes/scene/files.hpp"

namespace beamcam::scenes {
namespace {

std::string schema_of_file(const std::vector<const char*>& endings, bool numbered) {
    std::string kinds;
    for (const char* ending : endings) kinds += (kinds.empty() ? "" : "|") + std::string(ending + 1);
    static constexpr const char* kInside = R"(^(?!/)(?!.*(^|/)\\.\\.(/|$))(?!(.*/)?\\.[^/]*$))";
    return fmt::format(R"({{"type": "string", "minLength": 1, "maxLength": 4096, "pattern": "{}{}\\.({})$"}})", kInside,
                       numbered ? R"([^#\\u0000-\\u001f\\u007f]*#{1,9}[^/#\\u0000-\\u001f\\u007f]*)"
                                : R"([^#\\u0000-\\u001f\\u007f]+)",
                       kinds);
}

std::string problem_with_name(const std::string& name, const std::vector<const char*>& endings, bool numbered) {
    if (std::string problem = problem_with_file(name); !problem.empty()) return problem;
    if (std::ranges::find(endings, ending_of(name)) == endings.end())
        return fmt::format("its name must end in {}{}", fmt::join(endings, " or "), absent(ending_of(name)));
    if (numbered) return problem_with_numbering(name);
    return name.find('#') == std::string::npos
               ? ""
               : "only the output \"frames\" can have '#' in its name; choose another name";
}

}  // namespace

ValueFormat file_format(std::string& file, std::initializer_list<const char*> allowed, bool numbered) {
    const std::vector<const char*> endings(allowed);
    const auto read = [&file, endings, numbered](ObjectReader& r, const Node& node, const std::string& key) {
        if (node.kind != Node::Kind::string) return r.expect(node, key, "a file name in quotes");
        if (std::string problem = problem_with_name(node.text, endings, numbered); !problem.empty())
            return r.reject_value(node, key, ": {}", problem);
        file = node.text;
    };
    return {"file name", schema_of_file(endings, numbered), read,
            [&file] { return file.empty() ? Node() : Node(file); }};
}

void visit_file(SceneVisitor& v, std::string& file, std::initializer_list<const char*> endings, const char* ending,
                const char* meaning, const char* note) {
    const std::string text =
        fmt::format("{}{}; by default NAME{}, where NAME is the name of the scene.{}", meaning,
                    endings.size() > 1 ? fmt::format(" ({})", fmt::join(endings, " ")) : "", ending, note);
    v.value("file", file_format(file, endings, is_numbered(ending)), text.c_str());
    v.check([&file, ending](ObjectReader& r) {
        if (file.empty()) file = r.context().scene.name + ending;
    });
}

void visit_exaggeration(SceneVisitor& v, std::optional<double>& factor, const char* meaning) {
    v.number(sim::written_if(factor.has_value(), "exaggeration"), factor, sim::kPlainNumber,
             sim::between(1, 1e6, "is outside 1 (true shape) … 1e6"), meaning, "auto");
}

}  // namespace beamcam::scenes
