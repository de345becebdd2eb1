# SPDX-License-Identifier: GPL-3.0-or-later
# Liquid share of every throat at time t: before it the steps of a drying apply whole, the
# one under way in proportion. Reads kinds, times of the steps, where their changes begin,
# and the changes (throat, saturation).
table == 1 { liquid[n_throat++] = ($1 == 0) }
table == 2 { time[n_step++] = $1 }
table == 3 { begin[FNR - 1] = $1 }
table == 4 {
    i = FNR - 1
    while (i >= begin[now + 1]) now++
    if (now == 0 || time[now] <= t)
        liquid[$1] = $2
    else if (time[now - 1] < t)
        liquid[$1] += ($2 - liquid[$1]) * (t - time[now - 1]) / (time[now] - time[now - 1])
}
END { for (i = 0; i < n_throat; i++) print liquid[i] }
