#include "output/files/errors.hpp"

#include <cerrno>
#include <system_error>

namespace beamcam::output {

namespace {

const char* remedy(int error_number) {
    switch (error_number) {
        case ENOSPC:
        case EDQUOT:
            return "; free some space or choose another directory";
        case EFBIG:
            return "; the file is larger than this disk or this shell's limit (ulimit -f) allows";
        case EACCES:
        case EPERM:
        case EROFS:
            return "; choose a directory that you may write to";
        case ENOENT:
            return "; make the directory first or choose another one";
        case ENOTDIR:
            return "; a part of its path is a file, not a directory";
        case EISDIR:
            return "; choose another file name";
        case ENAMETOOLONG:
            return "; choose a shorter file name";
        case EMFILE:
        case ENFILE:
            return "; close some programs or raise the limit (ulimit -n)";
        default:
            return "";
    }
}

}  // namespace

IoError write_error(const std::filesystem::path& file, int error_number) {
    return IoError("cannot write " + file.string() + ": " + std::generic_category().message(error_number) +
                   remedy(error_number));
}

IoError read_error(const std::filesystem::path& file, int error_number) {
    const char* remedy = error_number == ENOENT   ? "; correct its name, or make the file first"
                         : error_number == EACCES ? "; change its permissions, or read a copy of it"
                                                  : "";
    return IoError("cannot read " + file.string() + ": " + std::generic_category().message(error_number) + remedy);
}

IoError io_error(const std::filesystem::filesystem_error& error) {
    std::string files = error.path1().string();
    if (!error.path2().empty()) files += ", " + error.path2().string();
    return IoError("cannot use " + files + ": " + error.code().message() + remedy(error.code().value()));
}

}  // namespace beamcam::output
