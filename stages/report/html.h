// SPDX-License-Identifier: GPL-3.0-or-later
// Text for people, and what keeps it text in a page.
#pragma once

#include <jansson.h>
#include <stdio.h>

// TEXT, whatever it holds, as text of an element or of an attribute in quotes. PAGE is
// any stream; a failure of it is found when the page is written.
void put_text(FILE *page, const char *text);

// The same, of a format.
void put_line(FILE *page, const char *format, ...)
    __attribute__((format(printf, 2, 3)));

// TEXT as text, between two pieces of markup, BEFORE and AFTER, which are written as
// they are.
void put_cell(FILE *page, const char *before, const char *text, const char *after);

// JSON that may stand in a script element: no "<" in it. Compact, ASCII, keys sorted.
// The caller frees it.
char *json_for_script(const json_t *json);

// TEXT as a JSON string, whatever its bytes are. The caller owns it.
json_t *text_json(const char *text);

// 5e-7 and "m": "500 nm"; three digits. Returns TEXT. A value of 0 has no prefix.
const char *with_unit(double value, const char *unit, char text[40]);

// VALUE to DIGITS digits, as %g, but without an exponent below 1e9: "1280". Returns
// TEXT.
const char *plain(double value, int digits, char text[40]);
