"""The bar of colours below a picture, with the sizes that they mean."""

from fonts import fitting_font, load_font
from size_scale import format_size, ramp_color, round_sizes, tick_position


def draw_legend(draw, top, total_width, size_range):
    """Draw the colour bar with its numbers and its caption below it."""
    bar_height = 34
    width = min(total_width - 380, 1300)
    left = (total_width - width) // 2
    font = load_font(28)
    for x in range(width):
        draw.line([(left + x, top), (left + x, top + bar_height)],
                  ramp_color(x / (width - 1)))
    draw.rectangle((left, top, left + width - 1, top + bar_height),
                   outline="black")
    draw.text((left - 24, top + bar_height / 2), "small", "black",
              anchor="rm", font=font)
    draw.text((left + width + 24, top + bar_height / 2), "large", "black",
              anchor="lm", font=font)
    low, high = size_range
    for value in spaced_ticks(low, high, width, font):
        x = left + tick_position(value, low, high) * (width - 1)
        draw.line([(x, top + bar_height), (x, top + bar_height + 9)], "black",
                  2)
        draw.text((x, top + bar_height + 40), format_size(value), "black",
                  anchor="ms", font=font)
    caption = "element size = mean edge length (unit of the mesh, log scale)"
    draw.text((total_width / 2, top + bar_height + 92), caption,
              (70, 70, 70), anchor="ms",
              font=fitting_font(caption, 28, total_width - 60))


def spaced_ticks(low, high, width, font):
    """Return the ends of the range and the round sizes with room between."""
    chosen = [low, high]
    for value in round_sizes(low, high):
        if all(abs(tick_position(value, low, high)
                   - tick_position(other, low, high)) * width
               > (font.getlength(format_size(value))
                  + font.getlength(format_size(other))) / 2 + 24
               for other in chosen):
            chosen.append(value)
    return sorted(chosen)
