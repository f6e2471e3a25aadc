#ifndef MESHGROW_WHOLE_FILE_H
#define MESHGROW_WHOLE_FILE_H

#include <functional>
#include <string>

namespace meshgrow {

/// Lets `write` make a file beside `path`, and moves it there when it is complete: the file is
/// there completely, or as before, also if the process is killed meanwhile. `write` returns false,
/// with errno set, if it could not. Throws Error that names the file then; what `write` throws is
/// passed on.
void write_whole_file(const std::string& path,
                      const std::function<bool(const std::string& unfinished)>& write);

/// Where write_whole_file has it until it is complete.
std::string unfinished_name(const std::string& path);

/// Where a file of this name really is: the end of symbolic links.
std::string place_of_file(const std::string& path);

/// Why no file can be put there, in a few words: it is a directory, or a device or the like, which
/// a file must not replace. Empty if one can.
std::string reason_against_file(const std::string& path);

/// Whether more could be written behind what is in the file. If not, its writer, unless it checks
/// by itself, may have lost the rest of what it wrote. Leaves the file as it is.
bool has_room_behind(const std::string& path);

}  // namespace meshgrow

#endif
