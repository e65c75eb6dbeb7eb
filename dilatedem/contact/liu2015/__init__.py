"""Contact model `liu2015`: one patch per pair, and on it the law of its mode, as Liu, Long & Ji (2015) print them.

`patch` clips the features that face each other and says in which of the seven modes they meet, where, and over what length or area;
`press` has the normal laws. What of the paper cannot be used as printed is said in docs/theory.md.
"""
