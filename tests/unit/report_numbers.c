// SPDX-License-Identifier: GPL-3.0-or-later
// A page shows counts and ends of axes as people write them, without an exponent.
#include "../test.h"
#include "report/html.h"

TEST(numbers_as_one_writes_them)
{
    static const struct {
        double value;
        int digits;
        const char *text;
    } number[] = {
        {1280, 3, "1280"},     {1283, 3, "1280"},       {-1283, 3, "-1280"},
        {999.6, 3, "1000"},    {1234567, 4, "1235000"}, {9.994e4, 3, "99900"},
        {324.4, 3, "324"},     {0.01234, 3, "0.0123"},  {0, 3, "0"},
        {123456, 9, "123456"}, {3.2e12, 3, "3.2e+12"},  {2.5e-9, 3, "2.5e-09"}};
    for (size_t k = 0; k < sizeof number / sizeof *number; k++) {
        char text[40];
        assert_string_equal(plain(number[k].value, number[k].digits, text),
                            number[k].text);
    }
}
