// SPDX-License-Identifier: GPL-3.0-or-later
// Names of files and texts of artifacts may hold anything. So every text goes through
// put_text, which leaves no character that begins a tag, an entity or the end of an
// attribute; and JSON in a script has "<" as \u003c, so that no "</script>" can end it.
// Control characters, which HTML does not allow, become blanks.
#include "html.h"

#include "basics/memory.h"
#include "basics/status.h"

#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

// &#39;, because attributes may be in single quotes.
void put_text(FILE *page, const char *text)
{
    for (const char *c = text; *c; c++)
        switch (*c) {
        case '&':
            fputs("&amp;", page);
            break;
        case '<':
            fputs("&lt;", page);
            break;
        case '>':
            fputs("&gt;", page);
            break;
        case '"':
            fputs("&quot;", page);
            break;
        case '\'':
            fputs("&#39;", page);
            break;
        default:
            fputc((unsigned char)*c < ' ' && *c != '\n' && *c != '\t' ? ' ' : *c, page);
        }
}

void put_line(FILE *page, const char *format, ...)
{
    char *text = NULL;
    va_list values;
    va_start(values, format);
    if (vasprintf(&text, format, values) < 0) die(STATUS_INTERNAL, "out of memory");
    va_end(values);
    put_text(page, text);
    free(text);
}

void put_cell(FILE *page, const char *before, const char *text, const char *after)
{
    fputs(before, page);
    put_text(page, text);
    fputs(after, page);
}

// Keys sorted and nine digits: the same run gives the same bytes.
char *json_for_script(const json_t *json)
{
    char *text = json_dumps(json, JSON_COMPACT | JSON_ENSURE_ASCII | JSON_SORT_KEYS |
                                      JSON_REAL_PRECISION(9));
    if (!text) die(STATUS_INTERNAL, "out of memory");
    char *safe = allocate(6 * strlen(text) + 1, 1), *end = safe;
    for (const char *c = text; *c; c++)
        if (*c == '<')
            end = stpcpy(end, "\\u003c");
        else
            *end++ = *c;
    free(text);
    return safe;
}

// Names of files need not be UTF-8, JSON must be.
json_t *text_json(const char *text)
{
    json_t *json = json_string(text);
    if (json) return json;
    char *plain = duplicate(text, strlen(text) + 1, 1); // it is not UTF-8
    for (char *c = plain; *c; c++)
        if ((unsigned char)*c > 126) *c = '?';
    json = json_string(plain);
    free(plain);
    return json;
}

// 1.0005: what rounds up to 1000 at three digits gets the next prefix. From atto to
// tera.
const char *with_unit(double value, const char *unit, char text[40])
{
    static const char *const prefix[] = {"a", "f", "p", "n", "µ", "m",
                                         "",  "k", "M", "G", "T"};
    int k = 6;
    if (value != 0 && isfinite(value))
        k = (int)floor(log10(fabs(value) * 1.0005) / 3) + 6;
    k = k < 0 ? 0 : k > 10 ? 10 : k;
    const double scaled = value / pow(10, 3 * (k - 6));
    snprintf(text, 40,
             fabs(scaled) < 999.5 && fabs(scaled) >= 100 ? "%.0f %s%s" : "%.3g %s%s",
             scaled, prefix[k], unit);
    return text;
}

const char *plain(double value, int digits, char text[40])
{
    snprintf(text, 40, "%.*e", digits - 1, value);
    const double rounded = strtod(text, NULL), size = fabs(rounded);
    if (size >= 1 && size < 1e9 && log10(size) >= digits)
        snprintf(text, 40, "%.0f", rounded);
    else
        snprintf(text, 40, "%.*g", digits, value);
    return text;
}
