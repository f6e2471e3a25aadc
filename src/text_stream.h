#ifndef MESHGROW_TEXT_STREAM_H
#define MESHGROW_TEXT_STREAM_H

#include <sstream>

namespace meshgrow {

/// A stream into a text. It throws std::bad_alloc when memory runs out, where the standard one ends
/// the text without a word.
class TextStream : public std::ostringstream {
 public:
  TextStream() { exceptions(std::ios::badbit); }
};

}  // namespace meshgrow

#endif
