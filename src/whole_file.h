#ifndef MESHGROW_WHOLE_FILE_H
#define MESHGROW_WHOLE_FILE_H

#include <functional>
#include <string>

namespace meshgrow {

/// Lets `write` make a file beside `path`, and moves it there when it is complete: the file is
/// there completely, or as before. `write` returns false, with errno set, if it could not. Throws
/// Error that names the file then; what `write` throws is passed on.
void write_whole_file(const std::string& path,
                      const std::function<bool(const std::string& unfinished)>& write);

}  // namespace meshgrow

#endif
